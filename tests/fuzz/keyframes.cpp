// Motions by keyframes, with their gestures.

#include "fuzz_scenes.hpp"
#include "hypotrack/api/config.hpp"
#include "motion/script.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(keyframes, "yaml") {
  const ConfigNode source = ConfigNode::parse(bytes, "scene.yaml", scratch());
  const synthetic::Gestures gestures(source.get("gestures"), {});
  const synthetic::Script script =
      synthetic::read_script(source.get("keyframes"), gestures, hand_and_box(), 30);
  for (const double share : {0.0, 0.3, 0.5, 1.0})
    require(script.state(share * script.duration).allFinite(), "states are finite");
}

}  // namespace hypotrack::fuzz
