#pragma once

#include "hypotrack/params.hpp"

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
    v("curl_sigma_deg", curl_sigma,
      {.help =
           "how far a finger's middle joint strays from `curl` times the knuckle: there it costs "
           "1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("curl", curl,
      {.help = "flexion of a finger's middle joint for that of its knuckle", .min = 0, .max = 4});
    v("neighbor_sigma_deg", neighbor_sigma,
      {.help = "how far a finger's knuckle is bent otherwise than that of the finger beside it: "
               "there it costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("abduction_sigma_deg", abduction_sigma,
      {.help = "how far a finger strays sideways: there it costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("thumb_sigma_deg", thumb_sigma,
      {.help = "how far a joint of a thumb strays from where it is in a relaxed hand: there it "
               "costs 1",
       .min = 0.01,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
  }
};

}  // namespace hypotrack::plausible_motion
