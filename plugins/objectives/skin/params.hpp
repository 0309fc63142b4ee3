#pragma once

#include <span>
#include <string_view>

#include "hypotrack/params.hpp"
#include "settings.hpp"

namespace hypotrack::skin {

std::span<const std::string_view> enum_names(Foreground);

/// Parameters of `type: skin`.
struct Params : Settings {
  void visit(ParamVisitor& v) {
    v("foreground", foreground,
      {.help = "what tells foreground: color: colours learned under the pose of the first frames; "
               "mask: the frame's mask; depth: all within range_mm of the last solution's depth; "
               "auto: the mask where there is one, otherwise color"});
    v("learn_frames", learn_frames,
      {.help = "colours are learned on this many frames that show the models, and then kept",
       .min = 1,
       .max = 10000});
    v("pose_error_mm", pose_error,
      {.help = "how wrong the poses of those frames may be: within this distance of the "
               "silhouette's edge a pixel's place says little about whether it is foreground",
       .min = 0,
       .max = 1e3,
       .unit = "mm",
       .to_si = kMillimetre});
    v("guess_trust", guess_trust,
      {.help = "how much colours count that were learned under a start that is only a guess, "
               "before the first solution; later frames replace them",
       .min = 0,
       .max = 1});
    v("spill", spill,
      {.help = "what covering a background pixel costs; leaving a foreground pixel uncovered "
               "costs 1",
       .min = 0,
       .max = 1e3});
    v("still_cameras", still_cameras,
      {.help = "foreground: color: the cameras do not move; what each pixel shows without the "
               "models is learned, and a pixel that shows it is background"});
    v("range_mm", range,
      {.help = "foreground: depth: how far before and behind the last solution it reaches",
       .min = 0,
       .max = 1e4,
       .unit = "mm",
       .to_si = kMillimetre});
  }
};

}  // namespace hypotrack::skin
