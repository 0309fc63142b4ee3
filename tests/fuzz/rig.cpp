// Rig files, on a hand of sticks.

#include "rig.hpp"

#include "stick_hand.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(rig, "yaml") {
  static const ImportedMesh mesh = test::stick_hand();
  const Rig rig = read_rig(scratch_file("rig.yaml", bytes));
  const Model hand(rig_hand(mesh, rig, "rig.yaml"));
  require(hand.dimension() == 27, "a hand has 27 parameters");
  require(hand.data().landmarks.size() == 21, "a hand has 21 landmarks");
}

}  // namespace hypotrack::fuzz
