#include "calibrate/board/wrong_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "calibrate/board/charuco.hpp"
#include "calibrate/board/chessboard.hpp"

namespace hypotrack::calibrate {
namespace {

constexpr const char* kSquaresCounted = " (inner corners are counted, not squares)";

bool is_charuco(const Board& board) { return board.kind == Board::Kind::charuco; }

/// Returns whether a board has the given size. A chessboard may be turned. A ChArUco board may
/// have rows that are not seen, or not used.
bool same_size(const Board& given, cv::Size seen) {
  if (is_charuco(given)) return seen.width == given.size.width;
  return seen == given.size || seen == cv::Size(given.size.height, given.size.width);
}

/// Returns a chessboard's size with the longer side where the given one has it.
cv::Size turned_as(cv::Size given, cv::Size seen) {
  if ((given.width < given.height) == (seen.width < seen.height)) return seen;
  return {seen.height, seen.width};
}

std::string name_of(const Board& given, cv::Size size) {
  return fmt::format("{}{}x{}", is_charuco(given) ? "charuco:" : "", size.width, size.height);
}

/// Returns what a board of another size is, and what to give.
std::string advice(const Board& given, cv::Size seen) {
  if (is_charuco(given))
    return fmt::format(
        "a ChArUco board of {} columns and at least {} rows of squares: give "
        "--board {}, columns first",
        seen.width, seen.height, name_of(given, seen));
  seen = turned_as(given.size, seen);
  return fmt::format("a chessboard of {} inner corners: give --board {}{}", name_of(given, seen),
                     name_of(given, seen),
                     seen + cv::Size(1, 1) == given.size ? kSquaresCounted : "");
}

/// Returns the value that a share of a picture's pixels is below.
double quantile(const cv::Mat& picture, double share) {
  cv::Mat values;
  picture.convertTo(values, CV_32F);
  std::vector<float> all(values.begin<float>(), values.end<float>());
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(share * double(all.size() - 1));
  std::ranges::nth_element(all, at);
  return *at;
}

/// Returns the slope of the steepest edges, in grey levels per pixel.
double steepest(const cv::Mat& gray) {
  constexpr double kSobel = 8;  // sum of the weights of one side, twice
  cv::Mat dx, dy, slope;
  cv::Sobel(gray, dx, CV_32F, 1, 0, 3, 1 / kSobel);
  cv::Sobel(gray, dy, CV_32F, 0, 1, 3, 1 / kSobel);
  cv::magnitude(dx, dy, slope);
  return quantile(slope, 0.995);
}

}  // namespace

std::string other_size(const Board& given, cv::Size seen) {
  if (seen.empty() || same_size(given, seen)) return {};
  const cv::Size as_given = is_charuco(given) ? seen : turned_as(given.size, seen);
  const bool part = !is_charuco(given) && as_given.width <= given.size.width &&
                    as_given.height <= given.size.height && as_given + cv::Size(1, 1) != given.size;
  return part ? "" : "this is " + advice(given, seen);
}

void SeenBoards::add(const BoardCorners& picture) {
  ++pictures_;
  found_ += picture.ids.empty() ? 0 : 1;
  other_patterns_ += picture.other_pattern ? 1 : 0;
  if (picture.seen.empty()) return;
  cv::Size size = picture.seen;
  if (same_size(given_, size)) size = given_.size;
  if (!is_charuco(given_)) size = turned_as(given_.size, size);
  ++seen_[{size.width, size.height}];
}

std::string SeenBoards::early_problem() const {
  constexpr int kSure = 6;
  return found_ > 0 ? pattern_problem(kSure) : problem(kSure);
}

std::string SeenBoards::pattern_problem(int least) const {
  if (other_patterns_ < least || 2 * other_patterns_ <= pictures_) return {};
  return fmt::format(
      "--pattern is {}, but the markers of {} of {} pictures lie in the other pattern: give "
      "--pattern {}, or leave it out",
      *given_.marker_first ? "marker" : "black", other_patterns_, pictures_,
      *given_.marker_first ? "black" : "marker");
}

std::string SeenBoards::problem(int least) const {
  if (const std::string pattern = pattern_problem(least); !pattern.empty()) return pattern;
  int all = 0, most = 0;
  cv::Size size;
  std::map<int, std::pair<int, int>> columns;  // rows and pictures of ChArUco boards
  for (const auto& [of, count] : seen_) {
    all += count;
    auto& [rows, pictures] = columns[of.first];
    rows = std::max(rows, of.second);
    pictures += count;
    if (!is_charuco(given_) && count > most) {
      most = count;
      size = {of.first, of.second};
    }
  }
  for (const auto& [width, of] : columns)
    if (is_charuco(given_) && of.second > most) {
      most = of.second;
      size = {width, of.first};
    }
  if (most < least || 2 * most <= all || same_size(given_, size)) return {};
  return fmt::format("--board is {}, but {} of {} pictures show {}", name_of(given_, given_.size),
                     most, pictures_, advice(given_, size));
}

std::string better_options(const Board& given, const cv::Mat& picture) {
  constexpr std::size_t kLeastMarkers = 4;
  constexpr int kWidth = 1280;
  const auto markers_of = [](Board board, const std::string& dictionary, const cv::Mat& gray) {
    board.dictionary = dictionary;
    return CharucoFinder(board).markers(gray);
  };
  const cv::Mat as_given = gray_of(picture, given.inverted, kWidth);
  if (is_charuco(given)) {
    if (markers_of(given, given.dictionary, as_given) >= kLeastMarkers) return {};
    cv::Mat mirror;
    cv::flip(as_given, mirror, 1);
    if (markers_of(given, given.dictionary, mirror) >= kLeastMarkers)
      return "the markers are mirrored: turn mirroring off, or flip the pictures";
  }
  for (const bool inverted : {given.inverted, !given.inverted}) {
    const cv::Mat gray = gray_of(picture, inverted, kWidth);
    const std::string invert = inverted == given.inverted ? ""
                               : inverted                 ? ", with --inverted"
                                                          : ", without --inverted";
    std::pair<std::size_t, std::string> most;
    for (const std::string& name : dictionary_names())
      if (const std::size_t markers = markers_of(given, name, gray); 4 * markers > 5 * most.first)
        most = {markers, name};  // large dictionaries contain small ones, and find some by chance
    if (most.first >= kLeastMarkers)
      return fmt::format("{} markers of the dictionary {} are seen: give {}--dictionary {}{}",
                         most.first, most.second,
                         is_charuco(given) ? "" : "--board charuco:COLUMNSxROWS ", most.second,
                         invert);
    const SeenChessboard chess = largest_chessboard(gray);
    if (chess.whole && (is_charuco(given) || !invert.empty()))
      return fmt::format("a chessboard of {}x{} inner corners is seen: give --board {}x{}{}",
                         chess.size.width, chess.size.height, chess.size.width, chess.size.height,
                         invert);
  }
  return {};
}

std::string why_no_board(const BoardFinder& finder, const cv::Mat& picture) {
  constexpr int kWidth = 320;
  constexpr double kDark = 60, kBright = 230, kFlat = 25;  // grey levels
  constexpr double kBlurred = 0.12;                        // slope as a share of the contrast
  const cv::Mat gray = gray_of(picture, false, kWidth);
  const double black = quantile(gray, 0.02), white = quantile(gray, 0.98);
  if (white < kDark) return "too dark";
  if (black > kBright) return "too bright";
  if (white - black < kFlat) return "nothing is seen: is the lens covered?";
  if (steepest(gray) < kBlurred * (white - black)) return "blurred";
  if (finder.sees_part(picture)) return "only a part of the board is seen";
  return "no board is seen";
}

}  // namespace hypotrack::calibrate
