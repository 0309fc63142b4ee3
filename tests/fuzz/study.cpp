// Study files. Written and read again they are the same study.

#include "lab/study/study_file.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(study, "yaml") {
  scratch_file("study/scene.yaml", "models: []\noptimizer: {type: pso}\n");
  const std::string text = to_yaml(study::load_study(scratch_file("study/study.yaml", bytes)));
  const std::string again = to_yaml(study::load_study(scratch_file("study/again.yaml", text)));
  require(text == again, "written and read again it is the same study");
}

}  // namespace hypotrack::fuzz
