#include "calibrate/board.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "calibrate/charuco.hpp"
#include "hypotrack/error.hpp"

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
  const cv::Mat picture = CharucoFinder(board).drawn({500, 700}, 20);
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
  const cv::Mat picture = CharucoFinder(board).drawn({540, 740}, 20);  // 100 pixels a square
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

}  // namespace
}  // namespace hypotrack::calibrate
