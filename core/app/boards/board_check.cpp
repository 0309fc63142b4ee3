#include "boards/board_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "calibrate/stereo_calibration.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::app {
namespace {

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

}  // namespace

void BoardCheck::measure(const std::array<Camera, 2>& cameras, const calibrate::PicturePair& pair) {
  calibrate::BoardPair found{pair.name, {finder_.find(pair.left), finder_.find(pair.right)}};
  for (const calibrate::BoardCorners& corners : found.corners) seen_.add(corners);
  if (finder_.whole_only())
    calibrate::number_alike(found.corners[0], found.corners[1], finder_.board().size);
  const auto fit = fit_board(finder_, cameras, found);
  if (!fit) {
    fmt::print("  the board is not seen in both pictures\n");
    return;
  }
  fmt::print("  board at {:.2f} m: its squares measure {:.2f} mm, its corners are {:.2f} px off\n",
             fit->depth, 1000 * fit->scale * finder_.board().square, fit->rms);
  fits_.push_back(*fit);
  pairs_.push_back(std::move(found));
}

void BoardCheck::expect_boards() const {
  if (const std::string problem = seen_.problem(); !problem.empty()) throw DataError(problem);
  if (fits_.empty())
    throw DataError("no pair shows the board in both pictures; are --board and its kind right?");
}

calibrate::BoardReach BoardCheck::reach() const {
  return own_ ? calibrate::BoardReach::calibrated : calibrate::BoardReach::measured;
}

/// Calibrates from the pictures alone, if there are enough good ones.
void BoardCheck::calibrate_alone(const std::array<Camera, 2>& cameras) {
  constexpr std::size_t kEnoughPairs = 8;
  if (pairs_.size() < kEnoughPairs) return;
  try {
    auto own = calibrate_stereo(finder_, {cameras[0].width, cameras[0].height}, pairs_);
    if (own.faults.empty() && verdict_of(pairs_, own).usable) own_ = std::move(own);
  } catch (const DataError&) {
    // Nothing to compare with: blind_spots() says so.
  }
}

double BoardCheck::residual() const {
  double squares = 0, corners = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (!own_->pairs[i].counts()) continue;
    const auto count = static_cast<double>(shared_corners(finder_, pairs_[i]).board.size());
    squares += count * fits_[i].rms * fits_[i].rms;
    corners += count;
  }
  return std::sqrt(squares / corners);
}

/// Compares cameras with the cameras found from the pictures alone. Returns whether they agree.
bool BoardCheck::print_own(const std::array<Camera, 2>& cameras) const {
  constexpr double kWorse = 1.3;                 // of the residuals
  constexpr double kCentre = 3, kFocal = 0.005;  // pixels, share
  constexpr double kSure = 4;                    // standard deviations
  double centre = 0, focal = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Camera &a = cameras[i], &b = own_->cameras[i];
    centre = std::max({centre, std::abs(a.cx - b.cx), std::abs(a.cy - b.cy)});
    focal = std::max({focal, std::abs(a.fx / b.fx - 1), std::abs(a.fy / b.fy - 1)});
  }
  const double given = residual();
  const double unsure = kSure * std::max(own_->focal_sigma[0], own_->focal_sigma[1]);
  const bool same =
      given < kWorse * own_->spread ||
      (centre < std::max(kCentre, unsure * cameras[0].fx) && focal < std::max(kFocal, unsure));
  fmt::print(
      "{}: corners are {:.3f} px off, {:.3f} with the cameras that these {} pairs give alone, "
      "whose "
      "centres are up to {:.1f} px and focal lengths up to {:.2f} % elsewhere\n",
      same ? "compared with a calibration from the board"
           : "the board does not agree, calibrate again",
      given, own_->spread, pairs_.size(), centre, 100 * focal);
  return same;
}

bool BoardCheck::print(const std::array<Camera, 2>& cameras) {
  const std::vector<calibrate::BoardFit>& boards = fits_;
  const double square = finder_.board().square;
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
  calibrate_alone(cameras);
  if (own_) agree = print_own(cameras) && agree;
  if (agree)
    fmt::print("the board agrees: its squares measure {:.2f} mm, its corners are {:.2f} px off\n",
               1000 * scale * square, rms);
  return agree;
}

}  // namespace hypotrack::app
