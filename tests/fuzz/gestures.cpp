// Tables of gestures.

#include "motion/gestures.hpp"

#include "fuzz_scenes.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(gestures, "yaml") {
  const synthetic::Gestures gestures({}, scratch_file("gestures.yaml", bytes));
  const Scene::Item& hand = hand_and_box().items()[0];
  for (const std::string& name : gestures.names()) {
    const std::vector<double> parameters = gestures.parameters(name, {}, hand);
    require(parameters.size() == 27, "a gesture sets every parameter");
  }
}

}  // namespace hypotrack::fuzz
