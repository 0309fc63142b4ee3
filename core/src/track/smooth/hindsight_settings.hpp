#pragma once

#include <cstdint>

#include "hypotrack/params.hpp"

namespace hypotrack {

/// `hindsight:` of a scene.
struct HindsightSettings {
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
      {.help =
           "change what was found by what later frames show before it is written; tracking goes "
           "on from the states as they were found, which are written into online.csv"});
    v("window_s", window,
      {.help = "frames of this time are looked at together; their pictures' tiles stay in memory",
       .min = 0.1,
       .max = 1e6,
       .unit = "s"});
    v("lag_s", lag,
      {.help = "a state is written once frames of this time after it have had their say; at most "
               "half the window",
       .min = 0,
       .max = 1e6,
       .unit = "s"});
    v("evaluations", evaluations,
      {.help = "evaluations per frame, which come off its budget", .min = 1, .max = 1 << 20});
    v("prior", prior,
      {.help =
           "factor on the weights of terms that look at the pose only: where later frames tell, "
           "what hands mostly do should say less",
       .min = 0,
       .max = 1e6});
    v("position_change_mm", position_change,
      {.help = "how much a model's speed changes in a second: there it costs 1",
       .min = 1e-3,
       .max = 1e9,
       .unit = "mm/s",
       .to_si = kMillimetre});
    v("rotation_change_deg", rotation_change,
      {.help = "the same of how fast it turns",
       .min = 1e-3,
       .max = 1e9,
       .unit = "deg/s",
       .to_si = kDegree});
    v("angle_change_deg", angle_change,
      {.help = "the same of every joint angle",
       .min = 1e-3,
       .max = 1e9,
       .unit = "deg/s",
       .to_si = kDegree});
  }
};

}  // namespace hypotrack
