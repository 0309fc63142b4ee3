#pragma once

#include <span>
#include <string_view>

#include "hypotrack/plugin/params.hpp"
#include "settings.hpp"

namespace hypotrack::rgbd_depth {

std::span<const std::string_view> enum_names(Foreground);

/// Parameters of `type: rgbd_depth`; the defaults of the first four are the papers'.
struct Params : Settings {
  void visit(ParamVisitor& v) {
    v("d_max_mm", d_max,
      {.help = "depth differences count up to this (the papers' d_M)",
       .min = 1e-3,
       .max = 1e4,
       .unit = "mm",
       .to_si = kMillimetre});
    v("d_match_mm", d_match,
      {.help = "depths that differ by this or less are the same surface (the papers' d_m)",
       .min = 1e-3,
       .max = 1e4,
       .unit = "mm",
       .to_si = kMillimetre});
    v("lambda", lambda,
      {.help = "weight of the silhouettes against the depth difference in cm",
       .min = 0,
       .max = 1e6});
    v("lambda_k", lambda_k,
      {.help = "weight of fingers that cross, per radian", .min = 0, .max = 1e6});
    v("foreground", foreground,
      {.help = "pixels that show the models: mask: the frame's mask; depth: all within range_mm of "
               "the last solution's depth; skin: pixels of depth with the colour of skin; auto: "
               "the mask if there is one, otherwise depth"});
    v("range_mm", range,
      {.help = "how far before and behind the last solution depth is foreground",
       .min = 0,
       .max = 1e4,
       .unit = "mm",
       .to_si = kMillimetre});
  }
};

}  // namespace hypotrack::rgbd_depth
