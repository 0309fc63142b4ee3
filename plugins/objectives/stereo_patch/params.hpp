#pragma once

#include <span>
#include <string_view>

#include "hypotrack/plugin/params.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

std::span<const std::string_view> enum_names(Measure);

/// Parameters of `type: stereo_patch`.
struct Params : Settings {
  void visit(ParamVisitor& v) {
    v("measure", measure,
      {.help = "how patches are compared: zero-mean normalised cross-correlation, or census (the "
               "share of neighbours that are darker than the middle in both views or in neither)"});
    v("radius", radius,
      {.help = "a patch has 2 radius + 1 pixels of the tile on each side", .min = 1, .max = 15});
    v("sharpness", sharpness,
      {.help = "similarity is exp(-sharpness (1 - z)), z the correlation", .min = 0, .max = 1e3});
    v("variance_floor", variance_floor,
      {.help = "zncc: added to each patch's variance (grey in 0..1), so that noise on uniform "
               "surfaces does not correlate",
       .min = 1e-9,
       .max = 1});
    v("range_mm", range,
      {.help = "depths that are compared: from this far before the last solution's nearest point "
               "to this far behind its farthest; others have no similarity",
       .min = 1,
       .max = 1e4,
       .unit = "mm",
       .to_si = kMillimetre});
    v("step_px", step,
      {.help =
           "distance of the depths that are compared, in pixels of the other view's tile; larger "
           "where they span over 72 pixels. Between them similarity is interpolated",
       .min = 0.1,
       .max = 4,
       .unit = "px"});
    v("r_mm", r,
      {.help = "a surface point is seen in both views if the depths rendered there agree this well",
       .min = 1e-3,
       .max = 1e3,
       .unit = "mm",
       .to_si = kMillimetre});
    v("full_at_difference", full_at_difference,
      {.help = "difference of the views' colours on the same surface in recent frames (red, green "
               "and blue in 0..1, after `photometric`) from which patches count in full; below it "
               "they count less. 0: always in full, as in the first frame",
       .min = 0,
       .max = 1});
    v("use_mask", use_mask,
      {.help = "pixels outside the frame's foreground mask, where it has one, weigh nothing"});
  }
};

}  // namespace hypotrack::stereo_patch
