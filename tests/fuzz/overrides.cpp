// Changes of a scene by `--set`, one in each line.

#include <sstream>

#include "hypotrack/api/config.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(overrides, "yaml") {
  static const std::filesystem::path scene = scratch_file(
      "overrides/scene.yaml",
      "models:\n  - {name: hand, type: hand}\noptimizer: {type: pso, center: [1, 2, 3]}\n");
  std::vector<std::string> overrides;
  std::istringstream in{std::string(bytes)};
  for (std::string line; std::getline(in, line);) overrides.push_back(line);
  const ConfigNode root = ConfigNode::load_scene(scene, overrides);
  require(root.is_map(), "an overridden scene is a map");
  ConfigNode::parse(root.to_yaml(), "written.yaml", scratch());
}

}  // namespace hypotrack::fuzz
