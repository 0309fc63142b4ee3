#include "boards/board_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>

#include "calibrate/board/wrong_board.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "live_pairs/status_line.hpp"
#include "messages.hpp"

namespace hypotrack::app {
namespace {

void expect_size(const calibrate::PicturePair& pair, cv::Size& size) {
  for (const cv::Mat& picture : {pair.left, pair.right}) {
    if (size.empty()) size = picture.size();
    if (picture.size() == size) continue;
    const bool turned = picture.size() == cv::Size(size.height, size.width);
    throw DataError(
        fmt::format("{}: a picture has {} x {} pixels, others {} x {}; expected one size{}",
                    pair.name, picture.cols, picture.rows, size.width, size.height,
                    turned ? ": is a camera turned by 90 degrees? Turn its pictures back" : ""));
  }
}

/// Returns whether both pictures show the board.
bool complete(const calibrate::BoardPair& pair) {
  return !pair.corners[0].ids.empty() && !pair.corners[1].ids.empty();
}

/// Returns the other layout of pictures of both views if both halves show the board in that.
std::string better_layout(const calibrate::BoardFinder& finder, std::optional<StereoLayout> layout,
                          const calibrate::PicturePair& pair) {
  if (!layout) return {};
  const bool beside = *layout == StereoLayout::side_by_side;
  const StereoLayout other = beside ? StereoLayout::top_bottom : StereoLayout::side_by_side;
  cv::Mat whole;
  if (beside)
    cv::hconcat(pair.left, pair.right, whole);
  else
    cv::vconcat(pair.left, pair.right, whole);
  for (const cv::Mat& view : split_views(other, whole))
    if (finder.find_quickly(view).ids.empty()) return {};
  return fmt::format("the board is seen in both halves, one {} the other: give --layout {}",
                     beside ? "above" : "beside",
                     enum_names(other)[static_cast<std::size_t>(other)]);
}

/// Remembers a pair without the board, and what to change. Throws DataError if that is clear.
void add_without(const calibrate::BoardFinder& finder, const calibrate::PairFiles& files,
                 const calibrate::PicturePair& pair, bool left_has_board, FoundBoards& out) {
  constexpr std::size_t kSure = 3;  // first pairs
  const cv::Mat& lacking = left_has_board ? pair.right : pair.left;
  if (out.without.empty()) out.why = calibrate::why_no_board(finder, lacking);
  const bool open = out.pairs.empty() && out.without.size() < kSure &&
                    (out.without.empty() || !out.advice.empty());
  out.without.push_back(pair.name);
  if (!open) return;
  out.advice = better_layout(finder, files.layout, pair);
  if (out.advice.empty()) out.advice = calibrate::better_options(finder.board(), lacking);
  if (out.without.size() < kSure || out.advice.empty()) return;
  throw DataError(
      fmt::format("none of the first {} pairs shows the board in both pictures. In {}, {}", kSure,
                  pair.name, out.advice));
}

}  // namespace

void read_noted_pairs(const calibrate::PairFiles& files,
                      const std::function<void(calibrate::PicturePair)>& take) {
  const auto note = [](const std::string& line) { tell("note: {}\n", line); };
  std::ranges::for_each(calibrate::notes_on(files), note);
  calibrate::read_pairs(files, take, note);
}

FoundBoards find_boards(const calibrate::BoardFinder& finder, const calibrate::PairFiles& files) {
  constexpr std::chrono::seconds kQuiet{10};  // where lines stay
  FoundBoards out;
  calibrate::SeenBoards seen(finder.board());
  StatusLine status(kQuiet);
  read_noted_pairs(files, [&](const calibrate::PicturePair& pair) {
    expect_size(pair, out.size);
    calibrate::BoardPair board{pair.name, {finder.find(pair.left), finder.find(pair.right)}};
    for (const calibrate::BoardCorners& corners : board.corners) seen.add(corners);
    if (finder.whole_only())
      calibrate::number_alike(board.corners[0], board.corners[1], finder.board().size);
    if (const std::string problem = seen.early_problem(); !problem.empty())
      throw DataError(problem);
    const auto again = [&](const calibrate::BoardPair& one) { return same_place(one, board); };
    if (!complete(board))
      add_without(finder, files, pair, !board.corners[0].ids.empty(), out);
    else if (std::ranges::any_of(out.pairs, again))
      out.repeated.push_back(board.name);
    else
      out.pairs.push_back(std::move(board));
    status.show(fmt::format("{} pairs are read, {} show the board in both pictures",
                            out.pairs.size() + out.without.size() + out.repeated.size(),
                            out.pairs.size() + out.repeated.size()));
  });
  return out;
}

std::string settle_pattern(const calibrate::Board& board, FoundBoards& boards) {
  std::vector<calibrate::BoardCorners*> pictures;
  for (calibrate::BoardPair& pair : boards.pairs)
    for (calibrate::BoardCorners& corners : pair.corners) pictures.push_back(&corners);
  const std::optional<bool> marker_first = calibrate::settle_pattern(pictures);
  if (!marker_first) return {};
  std::vector<calibrate::BoardPair> kept;
  for (calibrate::BoardPair& pair : boards.pairs)
    if (complete(pair))
      kept.push_back(std::move(pair));
    else
      boards.without.push_back(pair.name);
  boards.pairs = std::move(kept);
  return fmt::format("pattern: the top left square {}{}",
                     *marker_first
                         ? "has a marker, as OpenCV before 4.6 draws an even number of rows"
                         : "is black, as OpenCV from 4.6 on draws it",
                     board.marker_first ? "" : "; --pattern tells another one");
}

std::string marker_note(const calibrate::Board& board, const FoundBoards& boards) {
  constexpr double kSame = 0.1;
  std::vector<double> measured;
  for (const calibrate::BoardPair& pair : boards.pairs)
    for (const calibrate::BoardCorners& corners : pair.corners)
      if (corners.marker > 0) measured.push_back(corners.marker);
  if (measured.empty()) return {};
  const double seen = upper_median(measured), given = board.marker / board.square;
  if (std::abs(seen / given - 1) < kSame) return {};
  return fmt::format(
      "markers are {:.2f} of a square wide in the pictures, {:.2f} by --marker and --square; "
      "corners "
      "do not depend on that, but is --square right?",
      seen, given);
}

void expect_board(const calibrate::Board& board, const FoundBoards& boards) {
  constexpr std::size_t kLeastPairs = 3;
  calibrate::SeenBoards seen(board);
  for (const calibrate::BoardPair& pair : boards.pairs)
    for (const calibrate::BoardCorners& corners : pair.corners) seen.add(corners);
  if (const std::string problem = seen.problem(); !problem.empty()) throw DataError(problem);
  if (boards.pairs.size() >= kLeastPairs) return;
  const std::size_t showing = boards.pairs.size() + boards.repeated.size();
  if (showing >= kLeastPairs)
    throw DataError(fmt::format(
        "{} pairs show the board at {} different places; expected at least {}: move the board",
        showing, boards.pairs.size(), kLeastPairs));
  std::string what = "Are --board and its kind right, and is the whole board in view?";
  if (!boards.advice.empty())
    what = "In the first one without it, " + boards.advice;
  else if (!boards.why.empty())
    what = fmt::format("Of {}: {}. {}", boards.without.front(), boards.why, what);
  throw DataError(
      fmt::format("{} of {} pairs show the board in both pictures; expected at least {}. {}",
                  showing, showing + boards.without.size(), kLeastPairs, what));
}

}  // namespace hypotrack::app
