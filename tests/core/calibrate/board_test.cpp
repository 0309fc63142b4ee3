#include "calibrate/board/board.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "calibrate/board/charuco.hpp"
#include "calibrate/board/chessboard.hpp"
#include "calibrate/board/marker_layout.hpp"
#include "calibrate/board/wrong_board.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::calibrate {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Draws a chessboard with a margin.
cv::Mat chessboard(cv::Size corners, int square) {
  cv::Mat1b out((corners.height + 3) * square, (corners.width + 3) * square, uchar{255});
  for (int row = 0; row <= corners.height; ++row)
    for (int column = row % 2; column <= corners.width; column += 2)
      out(cv::Rect((column + 1) * square, (row + 1) * square, square, square)) = 0;
  return out;
}

TEST(Board, IsReadFromWords) {
  const Board chess = parse_board("9x6", "25mm");
  EXPECT_EQ(chess.kind, Board::Kind::chessboard);
  EXPECT_EQ(chess.size, cv::Size(9, 6));
  EXPECT_DOUBLE_EQ(chess.square, 0.025);
  const Board markers = parse_board("charuco:5x7", "3cm");
  EXPECT_EQ(markers.kind, Board::Kind::charuco);
  EXPECT_DOUBLE_EQ(markers.marker, 0.0225);
  for (const char* size : {"9", "9x", "x6", "9x6x2", "2x6", "9x-6", "charuco:", "aruco:5x7", ""})
    EXPECT_THAT([=] { parse_board(size, "25mm"); },
                ThrowsMessage<ConfigError>(HasSubstr("--board is '" + std::string(size))));
  for (const char* square : {"25", "mm", "-25mm", "25 mm", "25inch", "0m", "nan m", "1e9m"})
    EXPECT_THAT([=] { parse_board("9x6", square); },
                ThrowsMessage<ConfigError>(HasSubstr("expected a length with its unit")));
}

TEST(Board, ChessboardCornersAreFoundInAPicture) {
  const BoardFinder finder(parse_board("9x6", "25mm"));
  const BoardCorners found = finder.find(chessboard({9, 6}, 40));
  ASSERT_EQ(found.at.size(), 54u);
  EXPECT_EQ(found.ids.back(), 53);
  EXPECT_EQ(finder.place(10), cv::Point3f(0.025f, 0.025f, 0));
  EXPECT_NEAR(cv::norm(found.at[0] - found.at[1]), 40, 0.1);
  EXPECT_TRUE(finder.find(cv::Mat1b(480, 640, uchar{255})).ids.empty());
}

TEST(Board, LargePicturesAreSearchedQuicklyWithTheSameResult) {
  const BoardFinder finder(parse_board("9x6", "25mm"));
  const cv::Mat large = chessboard({9, 6}, 80);
  ASSERT_GT(large.cols, 640);
  EXPECT_EQ(finder.find_quickly(large).at, finder.find(large).at);
  EXPECT_EQ(finder.find_quickly(large).at.size(), 54u);
  EXPECT_TRUE(finder.find_quickly(cv::Mat1b(480, 960, uchar{255})).ids.empty());
}

TEST(Board, MarkersAreFoundInHalfAPictureAndInverted) {
  Board board = parse_board("charuco:5x7", "30mm");
  board.dictionary = "5X5_100";
  const cv::Mat picture = CharucoFinder(board).drawn(92, 20);
  EXPECT_EQ(BoardFinder(board).find(picture).ids.size(), 24u);
  const BoardCorners half = BoardFinder(board).find(picture(cv::Rect(0, 0, 500, 400)));
  EXPECT_GE(half.ids.size(), 8u);
  EXPECT_LT(half.ids.size(), 24u);
  cv::Mat inverse;
  cv::bitwise_not(picture, inverse);
  EXPECT_TRUE(BoardFinder(board).find(inverse).ids.empty());
  board.inverted = true;
  EXPECT_EQ(BoardFinder(board).find(inverse).ids.size(), 24u);
  board.inverted = false;
  board.dictionary = "7X7_50";
  EXPECT_TRUE(BoardFinder(board).find(picture).ids.empty());
}

TEST(Board, CornersBetweenMarkersAreNumberedAndPlacedRowByRow) {
  const Board board = parse_board("charuco:5x7", "30mm");
  const BoardFinder finder(board);
  const cv::Mat picture = CharucoFinder(board).drawn(100, 20);
  const BoardCorners found = finder.find(picture);
  ASSERT_EQ(found.at.size(), 24u);
  for (int id = 0; id < 24; ++id) {
    const cv::Point2f at = found.at[static_cast<std::size_t>(id)];
    EXPECT_EQ(found.ids[static_cast<std::size_t>(id)], id);
    EXPECT_NEAR(finder.place(id).x - finder.place(0).x, 0.03 * (id % 4), 1e-6);
    EXPECT_NEAR(std::abs(finder.place(id).y - finder.place(0).y), 0.03 * (id / 4), 1e-6);
    EXPECT_NEAR(at.x - found.at[0].x, 100 * (id % 4), 1);
    EXPECT_NEAR(std::abs(at.y - found.at[0].y), 100 * (id / 4), 1);
  }
  EXPECT_TRUE(finder.sees_part(picture));
  EXPECT_FALSE(finder.sees_part(cv::Mat1b(480, 640, uchar{255})));
}

TEST(Board, CornersThatWereCountedFromTheOtherEndAreTurned) {
  BoardCorners left, right;
  for (int i = 0; i < 54; ++i) {
    left.ids.push_back(i);
    left.at.emplace_back(static_cast<float>(i % 9 * 20), static_cast<float>(i / 9 * 20));
  }
  right = left;
  for (cv::Point2f& at : right.at) at.x -= 60;
  const BoardCorners expected = right;
  number_alike(left, right);
  EXPECT_EQ(right.at, expected.at);
  std::ranges::reverse(right.at);
  number_alike(left, right);
  EXPECT_EQ(right.at, expected.at);
}

TEST(Board, SquareBoardsAreNumberedAlikeAfterAQuarterOfATurn) {
  BoardCorners left, right;
  for (int i = 0; i < 25; ++i) {
    left.ids.push_back(i);
    left.at.emplace_back(static_cast<float>(i % 5 * 20), static_cast<float>(i / 5 * 20));
    right.at.emplace_back(static_cast<float>(i / 5 * 20 - 60), static_cast<float>(80 - i % 5 * 20));
  }
  right.ids = left.ids;
  number_alike(left, right, {5, 5});
  for (std::size_t i = 0; i < 25; ++i) EXPECT_EQ(right.at[i], left.at[i] - cv::Point2f(60, 0)) << i;
}

/// A ChArUco board in one of both patterns, drawn with 60 pixels a square.
struct DrawnBoard {
  DrawnBoard(const char* size, bool marker_first, double marker = 0.75)
      : board(parse_board(size, "30mm")) {
    Board of = board;
    of.marker = marker * of.square;
    of.marker_first = marker_first;
    cv::GaussianBlur(CharucoFinder(of).drawn(kSquare, kMargin), picture, {}, 0.8);
  }
  /// Returns how far corners are from their places at most, in pixels.
  double largest_distance(const BoardCorners& corners) const {
    const int columns = board.size.width - 1;
    double out = 0;
    for (std::size_t i = 0; i < corners.ids.size(); ++i) {
      const int id = corners.ids[i];
      const cv::Point2d place(kMargin + kSquare * (1 + id % columns) - 0.5,
                              kMargin + kSquare * (1 + id / columns) - 0.5);
      out = std::max(out, cv::norm(cv::Point2d(corners.at[i]) - place));
    }
    return out;
  }

  static constexpr int kSquare = 60, kMargin = 30;
  Board board;
  cv::Mat picture;
};

TEST(Board, MarkersAreFoundInBothPatternsAndCornersAtTheirPlaces) {
  for (const char* size : {"charuco:6x4", "charuco:5x4", "charuco:5x5", "charuco:6x5"})
    for (const bool marker_first : {false, true}) {
      const DrawnBoard drawn(size, marker_first);
      BoardCorners found = BoardFinder(drawn.board).find(drawn.picture);
      BoardCorners* const all[] = {&found};
      EXPECT_EQ(settle_pattern(all), marker_first) << size;
      EXPECT_EQ(found.ids.size(), (drawn.board.size - cv::Size(1, 1)).area()) << size;
      EXPECT_LT(drawn.largest_distance(found), 0.1) << size << marker_first;
    }
}

TEST(Board, APatternThatIsGivenIsTheOnlyOne) {
  DrawnBoard drawn("charuco:6x4", true);
  drawn.board.marker_first = true;
  EXPECT_EQ(BoardFinder(drawn.board).find(drawn.picture).ids.size(), 15u);
  drawn.board.marker_first = false;
  EXPECT_TRUE(BoardFinder(drawn.board).find(drawn.picture).ids.empty());
}

TEST(Board, APatternThatPicturesContradictIsNamed) {
  for (const char* size : {"charuco:6x4", "charuco:7x4"})
    for (const bool marker_first : {false, true}) {
      DrawnBoard drawn(size, marker_first);
      drawn.board.marker_first = !marker_first;
      const BoardCorners found = BoardFinder(drawn.board).find(drawn.picture);
      EXPECT_TRUE(found.ids.empty());
      SeenBoards seen(drawn.board);
      for (int i = 0; i < 6; ++i) seen.add(found);
      EXPECT_THAT(seen.early_problem(),
                  HasSubstr(std::string("the other pattern: give --pattern ") +
                            (marker_first ? "marker" : "black")));
    }
}

TEST(Board, CornersDoNotDependOnTheSizeOfMarkers) {
  for (const double share : {0.55, 0.65, 0.75, 0.8, 0.85}) {
    DrawnBoard drawn("charuco:6x4", true, share);
    const BoardCorners found = BoardFinder(drawn.board).find(drawn.picture);
    EXPECT_EQ(found.ids.size(), 15u) << share;
    EXPECT_LT(drawn.largest_distance(found), 0.1) << share;
    EXPECT_NEAR(found.marker, share, 0.03);
  }
}

TEST(Board, MirroredMarkersAreNamed) {
  const DrawnBoard drawn("charuco:6x4", false);
  cv::Mat mirror;
  cv::flip(drawn.picture, mirror, 1);
  EXPECT_TRUE(BoardFinder(drawn.board).find(mirror).ids.empty());
  EXPECT_THAT(better_options(drawn.board, mirror), HasSubstr("markers are mirrored"));
}

TEST(Board, AChessboardInPlaceOfMarkersIsNamed) {
  EXPECT_THAT(better_options(parse_board("charuco:10x7", "25mm"), chessboard({9, 6}, 30)),
              HasSubstr("a chessboard of "));
}

TEST(Board, PicturesThatLeaveThePatternOpenFollowTheOthers) {
  const DrawnBoard drawn("charuco:7x4", true);
  const cv::Mat part = drawn.picture(cv::Rect(30 + 60, 0, 5 * 60, drawn.picture.rows));
  const BoardFinder finder(drawn.board);
  BoardCorners open = finder.find(part), clear = finder.find(drawn.picture);
  ASSERT_EQ(open.patterns.size(), 2u);
  BoardCorners* const pictures[] = {&open, &clear};
  EXPECT_EQ(settle_pattern(pictures), true);
  for (cv::Point2f& at : open.at) at.x += 90;
  EXPECT_LT(drawn.largest_distance(open), 0.1);
}

TEST(Board, MarkersOfOtherColumnsTellTheBoard) {
  const DrawnBoard drawn("charuco:6x4", true);
  const Board given = parse_board("charuco:4x6", "30mm");
  const BoardCorners found = BoardFinder(given).find(drawn.picture);
  EXPECT_TRUE(found.ids.empty());
  SeenBoards seen(given);
  for (int i = 0; i < 6; ++i) seen.add(found);
  EXPECT_THAT(seen.early_problem(), HasSubstr("--board is charuco:4x6, but 6 of 6 pictures show"));
  EXPECT_THAT(seen.early_problem(), HasSubstr("give --board charuco:6x4, columns first"));
}

/// Returns what pictures of a board say about a size that is given.
std::string problem_of(const char* given, cv::Size real) {
  const Board board = parse_board(given, "25mm");
  const BoardCorners found = BoardFinder(board).find(chessboard(real, 30));
  SeenBoards seen(board);
  for (int i = 0; i < 6; ++i) seen.add(found);
  return seen.problem();
}

TEST(Board, ChessboardsOfAnotherSizeAreNamed) {
  EXPECT_EQ(problem_of("9x6", {9, 6}), "");
  EXPECT_EQ(problem_of("6x9", {9, 6}), "");
  EXPECT_EQ(problem_of("10x7", {9, 6}),
            "--board is 10x7, but 6 of 6 pictures show a chessboard of 9x6 inner corners: give "
            "--board 9x6 (inner corners are counted, not squares)");
  EXPECT_THAT(problem_of("8x6", {9, 6}), HasSubstr("give --board 9x6"));
  EXPECT_THAT(problem_of("5x8", {9, 6}), HasSubstr("give --board 6x9"));
  EXPECT_THAT(problem_of("9x6", {7, 7}), HasSubstr("give --board 7x7"));
}

TEST(Board, ATurnedBoardIsFoundInTheGivenOrder) {
  for (const char* size : {"9x6", "6x9"}) {
    const Board board = parse_board(size, "25mm");
    cv::Mat turned;
    cv::rotate(chessboard({9, 6}, 30), turned, cv::ROTATE_90_CLOCKWISE);
    const BoardCorners found = BoardFinder(board).find(turned);
    ASSERT_EQ(found.at.size(), 54u);
    const auto columns = static_cast<std::size_t>(board.size.width);
    const cv::Point2f x = found.at[1] - found.at[0], y = found.at[columns] - found.at[0];
    EXPECT_NEAR(cv::norm(x), 30, 0.2);
    EXPECT_NEAR(cv::norm(y), 30, 0.2);
    EXPECT_GT(x.cross(y), 0) << "seen from behind";
  }
}

TEST(Board, TheLargestChessboardIsSeenFromTheFront) {
  const SeenChessboard seen = largest_chessboard(chessboard({7, 5}, 30));
  EXPECT_EQ(seen.size.area(), 35);
  EXPECT_TRUE(seen.whole);
  const cv::Point2f x = seen.at[1] - seen.at[0],
                    y = seen.at[static_cast<std::size_t>(seen.size.width)] - seen.at[0];
  EXPECT_GT(x.cross(y), 0);
  EXPECT_TRUE(largest_chessboard(cv::Mat1b(240, 320, uchar{200})).size.empty());
}

TEST(Board, OptionsThatWouldFindABoardAreNamed) {
  const cv::Mat markers = DrawnBoard("charuco:6x4", false).picture;
  cv::Mat inverse;
  cv::bitwise_not(markers, inverse);
  Board given = parse_board("charuco:6x4", "30mm");
  EXPECT_EQ(better_options(given, markers), "");
  EXPECT_THAT(better_options(given, inverse), HasSubstr("with --inverted"));
  given.dictionary = "6X6_50";
  EXPECT_THAT(better_options(given, markers), HasSubstr("give --dictionary 4X4_50"));
  EXPECT_THAT(better_options(given, chessboard({9, 6}, 30)), HasSubstr("a chessboard of "));
  EXPECT_THAT(better_options(parse_board("9x6", "25mm"), markers),
              HasSubstr("give --board charuco:COLUMNSxROWS --dictionary 4X4_50"));
}

TEST(Board, BlurredCornersAreExpectedToBeLessCertain) {
  const BoardFinder finder(parse_board("9x6", "25mm"));
  const auto sigma = [&](double blur, double noise) {
    cv::Mat picture = chessboard({9, 6}, 30), grain(picture.size(), CV_16S);
    cv::GaussianBlur(picture, picture, {}, blur);
    cv::theRNG().state = 7;
    cv::randn(grain, 0, noise);
    cv::add(0.5 * picture, grain, picture, cv::noArray(), CV_8U);
    return finder.find(picture).sigma;
  };
  EXPECT_GT(sigma(0.7, 1), 0.02);
  EXPECT_LT(sigma(0.7, 1), 0.06);
  EXPECT_GT(sigma(3, 1), 2 * sigma(0.7, 1));
  EXPECT_GT(sigma(0.7, 12), 1.2 * sigma(0.7, 1));
}

}  // namespace
}  // namespace hypotrack::calibrate
