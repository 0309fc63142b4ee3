#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "boards/board_check.hpp"
#include "boards/board_pictures.hpp"
#include "boards/calibration_output.hpp"
#include "calibrate/check/check_reach.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "messages.hpp"

namespace hypotrack::app {
namespace {

/// Results of all pairs.
struct Judged {
  std::vector<double> distances;  ///< medians, pixels
  std::ptrdiff_t exchanged = 0;
  calibrate::CheckReach reach;
};

/// Prints the check of one pair.
void print_check(const std::string& name, const calibrate::MatchCheck& check, Judged& judged) {
  constexpr int kFew = 20;
  if (check.matches < kFew) {
    fmt::print("{}: {} matches, too few to tell\n", name, check.matches);
    return;
  }
  fmt::print(
      "{}: {} matches, median {:.2f} px from the epipolar line ({:+.2f} px with its sign), {:.0f} "
      "% "
      "consistent\n",
      name, check.matches, check.distance, check.offset, 100 * check.consistent);
  judged.distances.push_back(check.distance);
  judged.reach.add(check.points);
  if (!check.looks_exchanged()) return;
  fmt::print("  left and right seem exchanged: {:.0f} % are consistent the other way round\n",
             100 * check.consistent_exchanged);
  ++judged.exchanged;
}

/// Prints what the matches say together. Returns whether they agree with the calibration.
bool print_matches(const Judged& judged) {
  constexpr double kFar = 1.5;  // pixels
  const double distance = upper_median(judged.distances);
  if (2 * judged.exchanged > std::ssize(judged.distances)) {
    fmt::print("left and right are exchanged, in the pictures or in the calibration\n");
    return false;
  }
  if (distance >= kFar) {
    fmt::print(
        "calibration and pictures do not agree: {:.1f} px from the epipolar lines; calibrate "
        "again\n",
        distance);
    return false;
  }
  fmt::print("calibration and pictures agree: {:.2f} px from the epipolar lines\n", distance);
  return true;
}

/// Returns the two cameras for a pair of pictures, and prints the notes of their file once.
std::array<Camera, 2> cameras_for(const CalibrationSettings& settings,
                                  const calibrate::PicturePair& pair, bool print_notes) {
  std::vector<std::string> notes;
  std::vector<Camera> cameras =
      load_calibration(settings, {pair.left.cols, pair.left.rows}, &notes);
  if (cameras.size() != 2) {
    throw DataError(fmt::format("{}: has {} cameras; expected two, which --cameras chooses",
                                settings.file.string(), cameras.size()));
  }
  for (const std::string& note : notes)
    if (print_notes) tell("note: {}\n", note);
  fit_image_size(cameras[0], pair.left.cols, pair.left.rows, "the left pictures");
  fit_image_size(cameras[1], pair.right.cols, pair.right.rows, "the right pictures");
  return {cameras[0], cameras[1]};
}

std::optional<BoardCheck> board_check_of(const BoardOptions& options) {
  if (options.board.empty() != options.square.empty())
    throw ConfigError("--board and --square belong together; expected both or none");
  if (options.board.empty()) return std::nullopt;
  return std::optional<BoardCheck>(std::in_place, board_of(options));
}

}  // namespace

int check_calibration(const CalibrationSettings& settings, const calibrate::PairFiles& files,
                      const BoardOptions& options) {
  auto board = board_check_of(options);
  Judged judged;
  std::optional<std::array<Camera, 2>> cameras;
  const auto judge = [&](const calibrate::PicturePair& pair) {
    cameras = cameras_for(settings, pair, !cameras);
    print_check(pair.name, calibrate::check_matches(*cameras, pair.left, pair.right), judged);
    if (board) board->measure(*cameras, pair);
  };
  read_noted_pairs(files, judge);
  if (board) board->expect_boards();
  if (judged.distances.empty() && !board)
    throw DataError("no pair has enough matches; expected pictures of a scene with much texture");
  bool agree = judged.distances.empty() || print_matches(judged);
  if (board) agree = board->print(*cameras) && agree;
  fmt::print("these pictures do not tell:\n");
  for (const std::string& line :
       judged.reach.blind_spots(*cameras, board ? board->reach() : calibrate::BoardReach::none))
    fmt::print("- {}\n", line);
  return agree ? 0 : 1;
}

}  // namespace hypotrack::app
