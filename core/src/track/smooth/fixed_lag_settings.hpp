#pragma once

#include <cstdint>

#include "base/exported.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// `smoothing.fixed_lag:` of a scene.
struct FixedLagSettings {
  bool enabled = false;
  double window = 20;
  double lag = 2;
  std::int64_t evaluations = 128;
  double prior = 0.1;
  double position_change = 0.5;
  double rotation_change = 160 * kDegree;
  double angle_change = 160 * kDegree;
  void visit(ParamVisitor& v) {
    v("enabled", enabled,
      {.help = "smooth states over a fixed lag of later frames before they are written; tracking "
               "goes on from the unsmoothed states, which are written into online.csv"});
    v("window_s", window,
      {.help = "time of the frames that are smoothed together; their tiles stay in memory",
       .min = 0.1,
       .max = 1e6,
       .unit = "s"});
    v("lag_s", lag,
      {.help = "a state is written once frames up to this much later are included; at most half "
               "the window",
       .min = 0,
       .max = 1e6,
       .unit = "s"});
    v("evaluations", evaluations,
      {.help = "evaluations per frame, which come off its budget", .min = 1, .max = 1 << 20});
    v("prior", prior,
      {.help = "factor on the weights of terms that score the state only; later frames make such "
               "priors less important",
       .min = 0,
       .max = 1e6});
    v("position_change_mm", position_change,
      {.help = "change of a model's speed within a second that costs 1",
       .min = 1e-3,
       .max = 1e9,
       .unit = "mm/s",
       .to_si = kMillimetre});
    v("rotation_change_deg", rotation_change,
      {.help = "change of a model's speed of rotation within a second that costs 1",
       .min = 1e-3,
       .max = 1e9,
       .unit = "deg/s",
       .to_si = kDegree});
    v("angle_change_deg", angle_change,
      {.help = "change of a joint angle's speed within a second that costs 1",
       .min = 1e-3,
       .max = 1e9,
       .unit = "deg/s",
       .to_si = kDegree});
  }
};

}  // namespace internal
}  // namespace hypotrack
