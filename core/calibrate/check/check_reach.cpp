#include "calibrate/check/check_reach.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "calibrate/check/coverage.hpp"

namespace hypotrack::calibrate {
namespace {

/// Returns the values that a twentieth of all is below and above.
std::array<double, 2> range_of(std::vector<double> values) {
  const std::size_t edge = values.size() / 20;
  std::ranges::sort(values);
  return {values[edge], values[values.size() - 1 - edge]};
}

}  // namespace

void CheckReach::add(const MatchedPoints& points) {
  if (points.depths.empty()) return;
  ++pairs_;
  flat_ += points.flat ? 1 : 0;
  depths_.insert(depths_.end(), points.depths.begin(), points.depths.end());
  for (std::size_t view = 0; view < 2; ++view)
    pixels_[view].at.insert(pixels_[view].at.end(), points.pixels[view].begin(),
                            points.pixels[view].end());
}

std::vector<std::string> CheckReach::blind_spots(const std::array<Camera, 2>& cameras,
                                                 BoardReach board) const {
  std::vector<std::string> out;
  if (board == BoardReach::none)
    out.push_back(fmt::format(
        "errors along the epipolar lines, so all depths, and the scale: measure a board (--board, "
        "--square), or the baseline of {:.1f} mm with a ruler",
        1000 * (cameras[0].camera_from_world * cameras[1].camera_from_world.inverse())
                   .translation()
                   .norm()));
  if (depths_.empty()) return out;
  const auto [nearest, farthest] = range_of(depths_);
  out.push_back(
      fmt::format("anything nearer than {:.2f} m or farther than {:.2f} m", nearest, farthest));
  for (std::size_t view = 0; view < 2; ++view) {
    const std::array<const BoardCorners*, 1> all = {&pixels_[view]};
    const Coverage coverage = coverage_of(all, {cameras[view].width, cameras[view].height});
    if (coverage.share >= kEnoughCoverage && coverage.empty.empty()) continue;
    out.push_back(
        fmt::format("the lens in {:.0f} % of the {} picture, where no points are{}",
                    100 * (1 - coverage.share), view == 0 ? "left" : "right",
                    coverage.empty.empty()
                        ? ""
                        : fmt::format(", as at the {}", fmt::join(coverage.empty, " and the "))));
  }
  if (board != BoardReach::calibrated)
    out.emplace_back(
        "centres that are some pixels off, where the cameras are turned to make up for it: give "
        "--board, --square and ten pairs with the board, tilted");
  constexpr double kMostly = 0.7;
  if (board != BoardReach::calibrated && flat_ > kMostly * pairs_)
    out.emplace_back(
        "focal lengths and distortion well, and whether the corners of a calibration board were "
        "taken for the right ones: all points of a picture lie on one plane, as on a board or a "
        "wall; take pictures of a room");
  return out;
}

}  // namespace hypotrack::calibrate
