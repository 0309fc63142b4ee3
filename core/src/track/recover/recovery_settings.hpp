#pragma once

#include <span>
#include <string_view>

#include "base/exported.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// When a recovery is computed.
enum class RecoveryRun {
  frame,       ///< within the frame that is lost
  background,  ///< in a separate thread, while frames go by
};
std::span<const std::string_view> enum_names(RecoveryRun);

/// `recovery:` of a scene.
struct RecoverySettings {
  bool enabled = true;
  RecoveryRun run = RecoveryRun::frame;
  ConfigNode from;
  double check = 1;
  int first_restarts = 8;
  int places = 6;
  int hypotheses = 2000;
  int refined = 80;
  int searched = 2;
  int tile = 64;
  double nearest = 0.25;
  double farthest = 1.2;
  void visit(ParamVisitor& v) {
    v("enabled", enabled,
      {.help = "search for lost models; false: continue from any answer, as the paper does"});
    v("run", run,
      {.help = "frame: within the frame that is lost; background: in a thread of its own, while "
               "frames are answered at once as lost (results then depend on timing)"});
    v("from", from,
      {.help =
           "starters that look for lost models, as in init.from; default: those of init.from, or "
           "global_search if these give a state"});
    v("check_s", check,
      {.help = "time between checks by detectors whether a tracked model is elsewhere; 0: never",
       .min = 0,
       .max = 1e6,
       .unit = "s"});
    v("first_restarts", first_restarts,
      {.help = "searches of the first frame, from around the given start", .min = 1, .max = 100});
    v("places", places, {.help = "places looked at per lost frame", .min = 1, .max = 100});
    v("hypotheses", hypotheses,
      {.help = "poses evaluated per place, at a coarse tile", .min = 8, .max = 1e6});
    v("refined", refined,
      {.help = "best of them refined by least squares, at the coarse tile", .min = 1, .max = 1e4});
    v("searched", searched,
      {.help = "best of those searched by the scene's optimizer, at each place until one is very "
               "probable",
       .min = 1,
       .max = 100});
    v("tile", tile, {.help = "pixels along one side of the coarse tile", .min = 16, .max = 1024});
    v("nearest_mm", nearest,
      {.help = "nearest depth of the search from the first camera",
       .min = 10,
       .max = 1e5,
       .unit = "mm",
       .to_si = kMillimetre});
    v("farthest_mm", farthest,
      {.help = "farthest depth of the search from the first camera",
       .min = 10,
       .max = 1e6,
       .unit = "mm",
       .to_si = kMillimetre});
  }
};

}  // namespace internal
}  // namespace hypotrack
