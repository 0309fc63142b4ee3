#include "track/loop/setup.hpp"

#include <fmt/format.h>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {

void check_looking(const TrackerParts& parts, bool recovers) {
  if (!parts.begins_by_looking) return;
  if (!recovers)
    throw ConfigError(
        "init.from looks for the models in the pictures, which takes recovery.enabled, a "
        "judge and an objective that compares pictures; give a start, for example "
        "`init: {pose: ...}`");
  if (parts.cameras.size() < 2)
    throw ConfigError(
        "init.from looks for the models in two views, and the source has one; give a start, for "
        "example `init: {pose: ...}`");
}

void reserve_evaluations(const FixedLagSettings& smoothing, std::int64_t of_sigmas,
                         Budget& budget) {
  if (smoothing.enabled) {
    if (budget.evaluations < 2 * smoothing.evaluations)
      throw ConfigError(fmt::format(
          "fixed-lag smoothing takes {} evaluations of a frame's budget, which is {}; give "
          "budget.evaluations {} or more, smoothing.fixed_lag.evaluations {} or less, or leave "
          "smoothing.fixed_lag.enabled off",
          smoothing.evaluations, budget.evaluations, 2 * smoothing.evaluations,
          budget.evaluations / 2));
    budget.evaluations -= smoothing.evaluations;
  }
  if (budget.evaluations < 2 * of_sigmas)
    throw ConfigError(
        fmt::format("uncertainty takes {} evaluations of a frame's budget, which is {}; give "
                    "budget.evaluations {} or more, or leave uncertainty.enabled off",
                    of_sigmas, budget.evaluations, 2 * of_sigmas));
  budget.evaluations -= of_sigmas;
}

std::string problem_of_start(const Frame& frame, const Eigen::VectorXd& state,
                             const TileMaker& tiles, double min_visible) {
  constexpr const char* kQuestion =
      "is the start (init) where the models are, and do the cameras and their units (calibration) "
      "belong to the pictures?";
  const double visible = tiles.visible_share(state);
  if (visible < min_visible)
    return fmt::format(
        "{:.0f} % of what the models cover at the start is inside every image, and a frame with "
        "less than {:.0f} % counts as lost (status.min_visible); {}",
        100 * visible, 100 * min_visible, kQuestion);
  switch (tiles.foreground_overlap(frame, state)) {
    case ForegroundOverlap::nowhere:
      return fmt::format(
          "the models at the start cover no foreground pixel of any mask, and such a frame counts "
          "as lost; {}",
          kQuestion);
    case ForegroundOverlap::in_parts:
      return fmt::format(
          "no point of the models at the start is on the foreground of all masks, and such a frame "
          "counts as uncertain; {}",
          kQuestion);
    default:
      return {};
  }
}

}  // namespace hypotrack::internal
