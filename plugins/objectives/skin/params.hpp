#pragma once

#include <span>
#include <string_view>

#include "hypotrack/plugin/params.hpp"
#include "settings.hpp"

namespace hypotrack::skin {

std::span<const std::string_view> enum_names(Foreground);

/// Parameters of `type: skin`.
struct Params : Settings {
  void visit(ParamVisitor& v) {
    v("foreground", foreground,
      {.help = "source of the foreground: color: colours learned under the pose of the first "
               "frames; mask: the frame's mask; depth: all within range_mm of the last solution's "
               "depth; auto: the mask if there is one, otherwise color"});
    v("learn_frames", learn_frames,
      {.help = "frames with the models in view on which colours are learned; then they stay",
       .min = 1,
       .max = 10000});
    v("pose_error_mm", pose_error,
      {.help = "error of the poses in those frames: within this distance of the silhouette's edge "
               "a pixel may be foreground or not",
       .min = 0,
       .max = 1e3,
       .unit = "mm",
       .to_si = kMillimetre});
    v("guess_trust", guess_trust,
      {.help = "weight of colours learned under a guessed start, before the first solution; later "
               "frames replace them",
       .min = 0,
       .max = 1});
    v("spill", spill,
      {.help = "cost of covering a background pixel; an uncovered foreground pixel costs 1",
       .min = 0,
       .max = 1e3});
    v("still_cameras", still_cameras,
      {.help = "foreground: color: the cameras do not move; pixels that look as they do without "
               "the models are background"});
    v("range_mm", range,
      {.help = "foreground: depth: how far before and behind the last solution it reaches",
       .min = 0,
       .max = 1e4,
       .unit = "mm",
       .to_si = kMillimetre});
  }
};

}  // namespace hypotrack::skin
