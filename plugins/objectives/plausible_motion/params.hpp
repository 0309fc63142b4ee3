#pragma once

#include "hypotrack/params.hpp"

namespace hypotrack::plausible_motion {

struct PlausibleMotionParams {
  double motion_sigma = 15 * kDegree;
  double coupling_sigma = 20 * kDegree;
  double coupling = 2.0 / 3.0;
  void visit(ParamVisitor& v) {
    v("motion_sigma_deg", motion_sigma,
      {.help = "how far a joint turns from one frame to the next: there it costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("coupling_sigma_deg", coupling_sigma,
      {.help = "how far a finger's last joint strays from `coupling` times the one before: there "
               "it costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("coupling", coupling,
      {.help = "flexion of a finger's last joint for that of the one before", .min = 0, .max = 2});
  }
};

}  // namespace hypotrack::plausible_motion
