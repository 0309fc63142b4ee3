#include "calibrate/wrong_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "calibrate/charuco.hpp"
#include "calibrate/chessboard.hpp"

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

cv::Mat small_gray_of(const cv::Mat& picture, bool inverted) {
  constexpr double kWidth = 1280;
  cv::Mat out = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, out, cv::COLOR_BGR2GRAY);
  const double scale = std::min(1.0, kWidth / out.cols);
  cv::resize(out, out, {}, scale, scale, cv::INTER_AREA);
  if (inverted) cv::bitwise_not(out, out);
  return out;
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
  if (picture.seen.empty()) return;
  cv::Size size = picture.seen;
  if (same_size(given_, size)) size = given_.size;
  if (!is_charuco(given_)) size = turned_as(given_.size, size);
  ++seen_[{size.width, size.height}];
}

std::string SeenBoards::early_problem() const {
  constexpr int kSure = 6;
  return found_ > 0 ? std::string() : problem(kSure);
}

std::string SeenBoards::problem(int least) const {
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
  if (is_charuco(given) &&
      CharucoFinder(given).markers(small_gray_of(picture, given.inverted)) >= kLeastMarkers)
    return {};
  for (const bool inverted : {given.inverted, !given.inverted}) {
    const cv::Mat gray = small_gray_of(picture, inverted);
    const std::string invert = inverted == given.inverted ? ""
                               : inverted                 ? ", with --inverted"
                                                          : ", without --inverted";
    const SeenChessboard chess = largest_chessboard(gray);
    if (chess.whole && (is_charuco(given) || !invert.empty()))
      return fmt::format("a chessboard of {}x{} inner corners is seen: give --board {}x{}{}",
                         chess.size.width, chess.size.height, chess.size.width, chess.size.height,
                         invert);
    for (const std::string& name : dictionary_names()) {
      Board board = given;
      board.dictionary = name;
      const std::size_t markers = CharucoFinder(board).markers(gray);
      if (markers >= kLeastMarkers)
        return fmt::format("{} markers of the dictionary {} are seen: give {}--dictionary {}{}",
                           markers, name, is_charuco(given) ? "" : "--board charuco:COLUMNSxROWS ",
                           name, invert);
    }
  }
  return {};
}

}  // namespace hypotrack::calibrate
