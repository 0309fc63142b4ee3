#include "calibrate/board/board.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "calibrate/board/charuco.hpp"
#include "calibrate/board/chessboard.hpp"
#include "calibrate/board/corner_noise.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::calibrate {
namespace {

constexpr double kUsualMarker = 0.75;  // of a square

/// Parses a number at the start of a text and removes it.
template <class T>
std::optional<T> take_number(std::string_view& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

cv::Size parse_size(std::string_view text, std::string_view whole) {
  constexpr int kLeast = 3, kMost = 100;
  const auto columns = take_number<int>(text);
  const bool by = text.starts_with('x');
  if (by) text.remove_prefix(1);
  const auto rows = take_number<int>(text);
  if (columns && by && rows && text.empty() && std::min(*columns, *rows) >= kLeast &&
      std::max(*columns, *rows) <= kMost)
    return {*columns, *rows};
  throw ConfigError(
      fmt::format("--board is '{}'; expected the inner corners of a chessboard, as 9x6, or the "
                  "squares of a ChArUco board, as charuco:5x7; {} to {} each",
                  whole, kLeast, kMost));
}

/// Returns corners of as many rows as columns in the order after a turn by 90 degrees.
std::vector<cv::Point2f> quarter_turn(const std::vector<cv::Point2f>& at, int columns) {
  std::vector<cv::Point2f> out;
  for (int row = 0; row < columns; ++row)
    for (int column = 0; column < columns; ++column)
      out.push_back(at[static_cast<std::size_t>(column * columns + columns - 1 - row)]);
  return out;
}

}  // namespace

double parse_length(std::string_view text, std::string_view what) {
  constexpr std::array<std::pair<std::string_view, double>, 3> kUnits = {
      {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}}};
  std::string_view unit = text;
  const auto number = take_number<double>(unit);
  const auto found = std::ranges::find(kUnits, unit, &decltype(kUnits)::value_type::first);
  if (number && *number > 0 && found != kUnits.end() && *number * found->second < 10)
    return *number * found->second;
  throw ConfigError(
      fmt::format("{} is '{}'; expected a length with its unit, as 25mm or 2.5cm", what, text));
}

Board parse_board(std::string_view size, std::string_view square) {
  constexpr std::string_view kCharuco = "charuco:";
  Board out;
  std::string_view numbers = size;
  if (size.starts_with(kCharuco)) {
    out.kind = Board::Kind::charuco;
    numbers.remove_prefix(kCharuco.size());
  }
  out.size = parse_size(numbers, size);
  out.square = parse_length(square, "--square");
  out.marker = kUsualMarker * out.square;
  return out;
}

void number_alike(const BoardCorners& left, BoardCorners& right, cv::Size board) {
  if (left.ids != right.ids || left.ids.empty()) return;
  const auto mean = [](const std::vector<cv::Point2f>& points) {
    cv::Point2f sum;
    for (const cv::Point2f& p : points) sum += p;
    return sum / static_cast<float>(points.size());
  };
  const cv::Point2f shift = mean(right.at) - mean(left.at);
  const bool quarters = board.width == board.height && right.at.size() == std::size_t(board.area());
  std::vector<cv::Point2f> turned = right.at;
  double best = std::numeric_limits<double>::infinity();
  for (int turns = 0; turns < 4; ++turns) {
    double apart = 0;
    for (std::size_t i = 0; i < left.at.size(); ++i)
      apart += cv::norm(left.at[i] + shift - turned[i]);
    if ((quarters || turns % 2 == 0) && apart < best) {
      best = apart;
      right.at = turned;
    }
    if (quarters)
      turned = quarter_turn(turned, board.width);
    else if (turns == 1)
      std::ranges::reverse(turned);
  }
}

std::optional<bool> settle_pattern(std::span<BoardCorners* const> pictures) {
  std::array<int, 2> explained{};  // by marker_first
  bool both = false;
  for (const BoardCorners* picture : pictures) {
    for (const PatternCorners& pattern : picture->patterns)
      explained[pattern.marker_first] += pattern.explained;
    both = both || !picture->patterns.empty();
  }
  if (!both) return std::nullopt;
  const bool marker_first = explained[1] > explained[0];
  for (BoardCorners* picture : pictures) {
    const auto used =
        std::ranges::find(picture->patterns, marker_first, &PatternCorners::marker_first);
    picture->ids = used == picture->patterns.end() ? std::vector<int>() : used->ids;
    picture->at = used == picture->patterns.end() ? std::vector<cv::Point2f>() : used->at;
  }
  return marker_first;
}

cv::Mat gray_of(const cv::Mat& picture, bool inverted, int widest) {
  cv::Mat out = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, out, cv::COLOR_BGR2GRAY);
  if (widest > 0 && widest < out.cols) {
    const double scale = static_cast<double>(widest) / out.cols;
    cv::resize(out, out, {}, scale, scale, cv::INTER_AREA);
  }
  if (inverted) cv::bitwise_not(out, out);
  return out;
}

BoardFinder::BoardFinder(const Board& board) : board_(board) {
  if (board.kind == Board::Kind::charuco) markers_ = std::make_unique<CharucoFinder>(board);
}
BoardFinder::~BoardFinder() = default;

BoardCorners BoardFinder::find(const cv::Mat& picture) const {
  const cv::Mat gray = gray_of(picture, board_.inverted);
  return markers_ ? with_sigma(gray, markers_->find(gray)) : chessboard(gray, false);
}

BoardCorners BoardFinder::with_sigma(const cv::Mat& gray, BoardCorners corners) const {
  const int columns = markers_ ? board_.size.width - 1 : board_.size.width;
  if (!corners.at.empty()) corners.sigma = corner_sigma(edge_look(gray, corners, columns));
  return corners;
}

BoardCorners BoardFinder::chessboard(const cv::Mat& gray, bool quickly) const {
  ChessboardCorners found = find_chessboard(gray, board_.size, quickly, slow_searches_);
  BoardCorners out;
  out.at = std::move(found.at);
  out.seen = found.seen;
  for (int i = 0; i < static_cast<int>(out.at.size()); ++i) out.ids.push_back(i);
  return with_sigma(gray, std::move(out));
}

BoardCorners BoardFinder::find_quickly(const cv::Mat& picture) const {
  return markers_ ? find(picture) : chessboard(gray_of(picture, board_.inverted), true);
}

bool BoardFinder::sees_part(const cv::Mat& picture) const {
  const cv::Mat gray = gray_of(picture, board_.inverted);
  return markers_ ? markers_->markers(gray) > 0 : cv::checkChessboard(gray, board_.size);
}

double BoardFinder::edge_width(const cv::Mat& picture, const BoardCorners& found) const {
  if (markers_) return 0;
  return cv::estimateChessboardSharpness(gray_of(picture, board_.inverted), board_.size,
                                         found.at)[0];
}

cv::Point3f BoardFinder::place(int id) const {
  if (markers_) return markers_->place(id);
  const int column = id % board_.size.width, row = id / board_.size.width;
  return {static_cast<float>(column * board_.square), static_cast<float>(row * board_.square), 0};
}

}  // namespace hypotrack::calibrate
