#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>

#include "calibrate/check/coverage.hpp"
#include "calibrate/stereo_calibration.hpp"

namespace hypotrack::calibrate {
namespace {

constexpr double kGood = 0.35, kUsable = 1.0;  // pixels
constexpr double kSharp = 0.15;      // pixels that corners of sharp pictures are off by at most
constexpr double kSureFocal = 0.01;  // standard deviation, share of the focal length
constexpr double kUnsureFocal = 0.03;
constexpr std::ptrdiff_t kFewPairs = 10;
constexpr double kManyDropped = 0.2;
constexpr double kTilted = 15 * std::numbers::pi / 180;
constexpr double kTiltedShare = 0.3;
constexpr double kParallel = 10 * std::numbers::pi / 180;

/// Returns whether the residuals are as small as corners of this sharpness give.
bool fits(const StereoCalibration& calibration) {
  return calibration.expected <= 0 || calibration.spread < kFittingResidual * calibration.expected;
}

/// Returns the advice on residuals.
std::vector<std::string> advice_on_residuals(const StereoCalibration& calibration) {
  std::vector<std::string> out;
  if (calibration.expected > kSharp)
    out.emplace_back("edges are blurred or noisy: hold the board still, with more light and focus");
  else if (calibration.rms >= kGood && calibration.expected <= 0)
    out.emplace_back(
        "corners are off: hold the board still and flat, with more light; are both pictures of a "
        "pair taken at the same time?");
  if (!fits(calibration) && calibration.faults.empty())
    out.push_back(fmt::format(
        "corners as sharp as these are some {:.2f} px off, not {:.2f}: is the board flat, is it "
        "the one that the options describe, and are both pictures of a pair taken at the same "
        "time?",
        calibration.expected, calibration.spread));
  return out;
}

}  // namespace

Verdict verdict_of(const std::vector<BoardPair>& pairs, const StereoCalibration& calibration) {
  Verdict out;
  const auto counted =
      std::ranges::count_if(calibration.pairs, [](const auto& pair) { return pair.counts(); });
  const auto tilted = std::ranges::count_if(
      calibration.pairs, [](const auto& pair) { return pair.counts() && pair.tilt > kTilted; });
  const double focal = std::max(calibration.focal_sigma[0], calibration.focal_sigma[1]);
  const bool lenses_found = focal > 0;
  const bool parallel = lenses_found && calibration.turn < kParallel;
  out.usable = calibration.rms < kUsable && focal < kUnsureFocal && !parallel;
  const bool good = calibration.spread < kGood && fits(calibration) && focal < kSureFocal &&
                    calibration.faults.empty() && !parallel;
  out.summary = fmt::format("{}: {:.3f} px RMS over {} pairs",
                            good         ? "good"
                            : out.usable ? "usable"
                                         : "not usable",
                            calibration.rms, counted);
  if (parallel)
    out.summary += ", focal lengths not known: the boards of all pairs are parallel";
  else if (lenses_found)
    out.summary += fmt::format(", focal lengths known to {:.1f} %", 100 * focal);
  out.advice = calibration.faults;
  for (std::string& advice : advice_on_residuals(calibration))
    out.advice.push_back(std::move(advice));
  const auto dropped = std::ranges::count_if(calibration.pairs, &PairResidual::dropped);
  if (kManyDropped * static_cast<double>(counted + dropped) < static_cast<double>(dropped))
    out.advice.push_back(
        fmt::format("{} of {} pairs are dropped: are both pictures of a pair taken at the same "
                    "time, and in the right order?",
                    dropped, counted + dropped));
  if (counted < kFewPairs)
    out.advice.push_back(fmt::format("take more pairs: {} count, 15 to 30 are usual", counted));
  if (!lenses_found) return out;
  if (static_cast<double>(tilted) < kTiltedShare * static_cast<double>(counted))
    out.advice.push_back(
        "tilt the board more, by 20 to 45 degrees in all directions: the focal length is seen from "
        "that only");
  for (std::size_t view = 0; view < 2; ++view) {
    const Coverage coverage = coverage_of(pairs, calibration, view);
    if (coverage.share >= kEnoughCoverage && coverage.empty.empty()) continue;
    const std::string where =
        coverage.empty.empty() ? "at new places"
                               : fmt::format("into the {}", fmt::join(coverage.empty, " and the "));
    out.advice.push_back(
        fmt::format("hold the board {} of the {} picture ({:.0f} % of it is covered)", where,
                    view == 0 ? "left" : "right", 100 * coverage.share));
  }
  return out;
}

}  // namespace hypotrack::calibrate
