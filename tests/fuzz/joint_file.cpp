// Motions by tables of joints, to which models are fitted.

#include "motion/joint_motion.hpp"
#include "target.hpp"
#include "test_models.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(joint_file, "csv") {
  static const Scene scene({{"box", std::make_shared<Model>(test::make_test_box())}});
  synthetic::JointFileParams params;
  params.file = scratch_file("joints.csv", bytes);
  params.units = LengthUnit::mm;
  params.smooth = 1;
  const synthetic::Script script = synthetic::read_joint_file(params, scene, 30);
  for (const double share : {0.0, 0.5, 1.0})
    require(script.state(share * script.duration).allFinite(), "states are finite");
}

}  // namespace hypotrack::fuzz
