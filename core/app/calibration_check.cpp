#include "calibration_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "board_pictures.hpp"
#include "calibrate/board_fit.hpp"
#include "calibrate/check_reach.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/median.hpp"
#include "tell.hpp"

namespace hypotrack::app {
namespace {

/// Results of all pairs.
struct Judged {
  std::vector<double> distances;  ///< medians, pixels
  std::ptrdiff_t exchanged = 0;
  std::vector<calibrate::BoardFit> boards;
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

/// Measures the board in a pair and prints the result.
void measure_board(const calibrate::BoardFinder& finder, const std::array<Camera, 2>& cameras,
                   const calibrate::BoardPair& pair, Judged& judged) {
  const auto fit = fit_board(finder, cameras, pair);
  if (!fit) {
    fmt::print("  the board is not seen in both pictures\n");
    return;
  }
  fmt::print("  board at {:.2f} m: its squares measure {:.2f} mm, its corners are {:.2f} px off\n",
             fit->depth, 1000 * fit->scale * finder.board().square, fit->rms);
  judged.boards.push_back(*fit);
}

/// Median of what boards measure on one side and on the other.
struct Halves {
  std::array<double, 2> scales{};
  double difference() const { return std::abs(scales[1] / scales[0] - 1); }
};

/// Splits boards at the median of a number. Returns 1 twice for few.
Halves halves(const std::vector<calibrate::BoardFit>& boards,
              double (*number)(const calibrate::BoardFit&)) {
  constexpr std::size_t kLeast = 6;
  if (boards.size() < kLeast) return {{1, 1}};
  std::vector<double> numbers;
  for (const auto& board : boards) numbers.push_back(number(board));
  const double middle = upper_median(numbers);
  std::array<std::vector<double>, 2> scales;
  for (const auto& board : boards) scales[number(board) >= middle].push_back(board.scale);
  if (scales[0].empty()) return {{1, 1}};
  return {{upper_median(scales[0]), upper_median(scales[1])}};
}

/// Prints what the boards say together. Returns whether they agree with the calibration.
bool print_boards(const std::vector<calibrate::BoardFit>& boards, double square) {
  constexpr double kSame = 0.01;   // share of a length
  constexpr double kSmall = 0.35;  // pixels
  std::vector<double> scales, residuals, expected;
  for (const auto& board : boards) {
    scales.push_back(board.scale);
    residuals.push_back(board.rms);
    expected.push_back(board.expected);
  }
  const double scale = upper_median(scales), rms = upper_median(residuals);
  const double sharp = upper_median(expected);
  bool agree = true;
  const auto differ = [&](const std::string& text) {
    fmt::print("the board does not agree: {}\n", text);
    agree = false;
  };
  if (std::abs(scale - 1) > kSame)
    differ(
        fmt::format("its squares measure {:.2f} mm, --square is {:.2f} mm; all lengths are {:.1f} "
                    "% off",
                    1000 * scale * square, 1000 * square, 100 * (scale - 1)));
  if (rms > kSmall || (sharp > 0 && rms > calibrate::kFittingResidual * sharp))
    differ(
        fmt::format("its corners are {:.2f} px off, corners as sharp as these {:.2f}", rms, sharp));
  const std::array<std::pair<const char*, Halves>, 3> splits = {
      {{"nearer and farther", halves(boards, [](const auto& b) { return b.depth; })},
       {"at the left and the right", halves(boards, [](const auto& b) { return b.centre.x; })},
       {"at the top and the bottom", halves(boards, [](const auto& b) { return b.centre.y; })}}};
  for (const auto& [where, half] : splits)
    if (half.difference() > kSame)
      differ(fmt::format("its squares measure {:.2f} and {:.2f} mm {}",
                         1000 * square * half.scales[0], 1000 * square * half.scales[1], where));
  if (agree)
    fmt::print("the board agrees: its squares measure {:.2f} mm, its corners are {:.2f} px off\n",
               1000 * scale * square, rms);
  return agree;
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

std::optional<calibrate::BoardFinder> finder_of(const BoardOptions& options) {
  if (options.board.empty() != options.square.empty())
    throw ConfigError("--board and --square belong together; expected both or none");
  if (options.board.empty()) return std::nullopt;
  return std::optional<calibrate::BoardFinder>(std::in_place, board_of(options));
}

}  // namespace

int check_calibration(const CalibrationSettings& settings, const calibrate::PairFiles& files,
                      const BoardOptions& board) {
  const auto finder = finder_of(board);
  Judged judged;
  std::optional<std::array<Camera, 2>> cameras;
  const auto judge = [&](const calibrate::PicturePair& pair) {
    cameras = cameras_for(settings, pair, !cameras);
    print_check(pair.name, calibrate::check_matches(*cameras, pair.left, pair.right), judged);
    if (!finder) return;
    calibrate::BoardPair found{pair.name, {finder->find(pair.left), finder->find(pair.right)}};
    if (finder->whole_only())
      calibrate::number_alike(found.corners[0], found.corners[1], finder->board().size);
    measure_board(*finder, *cameras, found, judged);
  };
  read_noted_pairs(files, judge);
  if (finder && judged.boards.empty())
    throw DataError("no pair shows the board in both pictures; are --board and its kind right?");
  if (judged.distances.empty() && judged.boards.empty())
    throw DataError("no pair has enough matches; expected pictures of a scene with much texture");
  bool agree = judged.distances.empty() || print_matches(judged);
  if (finder) agree = print_boards(judged.boards, finder->board().square) && agree;
  fmt::print("these pictures do not tell:\n");
  for (const std::string& line : judged.reach.blind_spots(*cameras, finder.has_value()))
    fmt::print("- {}\n", line);
  return agree ? 0 : 1;
}

}  // namespace hypotrack::app
