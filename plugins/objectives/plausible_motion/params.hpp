#pragma once

#include "hypotrack/plugin/params.hpp"

namespace hypotrack::plausible_motion {

struct PlausibleMotionParams {
  double motion_sigma = 45 * kDegree;
  double coupling_sigma = 10 * kDegree;
  double coupling = 2.0 / 3.0;
  double curl_sigma = 30 * kDegree;
  double curl = 1;
  double neighbor_sigma = 40 * kDegree;
  double abduction_sigma = 8 * kDegree;
  double thumb_sigma = 20 * kDegree;
  void visit(ParamVisitor& v) {
    v("motion_sigma_deg", motion_sigma,
      {.help = "turn of a joint from one frame to the next that costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("coupling_sigma_deg", coupling_sigma,
      {.help =
           "deviation of a finger's last joint from `coupling` times the one before that costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("coupling", coupling,
      {.help = "flexion of a finger's last joint for that of the one before", .min = 0, .max = 2});
    v("curl_sigma_deg", curl_sigma,
      {.help = "deviation of a finger's middle joint from `curl` times the knuckle that costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("curl", curl,
      {.help = "flexion of a finger's middle joint for that of its knuckle", .min = 0, .max = 4});
    v("neighbor_sigma_deg", neighbor_sigma,
      {.help = "difference of neighbouring fingers' knuckles that costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("abduction_sigma_deg", abduction_sigma,
      {.help = "sideways deviation of a finger that costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("thumb_sigma_deg", thumb_sigma,
      {.help = "deviation of a thumb's joint from a relaxed hand that costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
  }
};

}  // namespace hypotrack::plausible_motion
