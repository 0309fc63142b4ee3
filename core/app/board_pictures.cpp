#include "board_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "calibrate/wrong_board.hpp"
#include "hypotrack/error.hpp"
#include "live_pairs/status_line.hpp"
#include "tell.hpp"

namespace hypotrack::app {
namespace {

void expect_size(const calibrate::PicturePair& pair, cv::Size& size) {
  for (const cv::Mat& picture : {pair.left, pair.right}) {
    if (size.empty()) size = picture.size();
    if (picture.size() == size) continue;
    throw DataError(
        fmt::format("{}: a picture has {} x {} pixels, others {} x {}; expected one size",
                    pair.name, picture.cols, picture.rows, size.width, size.height));
  }
}

/// Returns whether both pictures show the board.
bool complete(const calibrate::BoardPair& pair) {
  return !pair.corners[0].ids.empty() && !pair.corners[1].ids.empty();
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
    if (complete(board)) {
      out.pairs.push_back(std::move(board));
    } else {
      const cv::Mat& lacking = board.corners[0].ids.empty() ? pair.left : pair.right;
      if (out.without.empty()) out.advice = calibrate::better_options(finder.board(), lacking);
      out.without.push_back(pair.name);
    }
    if (const std::string problem = seen.early_problem(); !problem.empty())
      throw DataError(problem);
    status.show(fmt::format("{} pairs are read, {} show the board in both pictures",
                            out.pairs.size() + out.without.size(), out.pairs.size()));
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

void expect_board(const calibrate::Board& board, const FoundBoards& boards) {
  constexpr std::size_t kLeastPairs = 3;
  calibrate::SeenBoards seen(board);
  for (const calibrate::BoardPair& pair : boards.pairs)
    for (const calibrate::BoardCorners& corners : pair.corners) seen.add(corners);
  if (const std::string problem = seen.problem(); !problem.empty()) throw DataError(problem);
  if (boards.pairs.size() >= kLeastPairs) return;
  throw DataError(fmt::format(
      "{} of {} pairs show the board in both pictures; expected at least {}. {}",
      boards.pairs.size(), boards.pairs.size() + boards.without.size(), kLeastPairs,
      boards.advice.empty() ? "Are --board and its kind right, and is the whole board in view?"
                            : "In the first one without it, " + boards.advice));
}

}  // namespace hypotrack::app
