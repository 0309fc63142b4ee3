#pragma once

#include "base/exported.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// `uncertainty:` of a scene. Widths are one standard deviation.
/// docs/results/uncertainty.md says what the defaults were fitted to.
struct UncertaintySettings {
  bool enabled = false;
  double noise = 1;
  double floor = 0.0003;
  double position = 0.050;
  double rotation = 20 * kDegree;
  double angle = 40 * kDegree;
  void visit(ParamVisitor& v) {
    v("enabled", enabled,
      {.help =
           "say for every landmark how far off it may be; needs objectives with residuals, and "
           "takes two evaluations per number of the pose and one more from the frame's budget"});
    v("noise", noise,
      {.help = "factor on what the residuals' scatter says; more where neighbouring pixels err "
               "together",
       .min = 1e-3,
       .max = 1e3});
    v("floor_mm", floor,
      {.help = "how far off a landmark may be however clear the images are",
       .min = 0,
       .max = 1e3,
       .unit = "mm",
       .to_si = kMillimetre});
    v("position_mm", position,
      {.help = "how far off a model's position may be, each axis, that the images do not show",
       .min = 1e-3,
       .max = 1e4,
       .unit = "mm",
       .to_si = kMillimetre});
    v("rotation_deg", rotation,
      {.help = "the same of a rotation", .min = 1e-3, .max = 180, .unit = "deg", .to_si = kDegree});
    v("angle_deg", angle,
      {.help = "the same of a joint angle; never more than its limits leave open",
       .min = 1e-3,
       .max = 180,
       .unit = "deg",
       .to_si = kDegree});
  }
};

}  // namespace internal
}  // namespace hypotrack
