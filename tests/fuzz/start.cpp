// Starts: a pose, or clicks.

#include "fuzz_scenes.hpp"
#include "hypotrack/api/clicks.hpp"
#include "hypotrack/api/pose.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(start, "yaml") {
  const ConfigNode node = ConfigNode::parse(bytes, "start.yaml", scratch());
  const Scene& scene = hand_and_box();
  bool read = attempt([&] {
    const Eigen::VectorXd state = read_pose(node, scene, scene.rest_state());
    require(state.allFinite(), "states are finite");
    read_pose(ConfigNode::parse(pose_yaml(scene, state, {true, true}), "written.yaml"), scene,
              scene.rest_state());
  });
  read |= attempt([&] {
    const ClickedFrame clicked = read_clicks(node);
    const std::string text = clicks_yaml(clicked);
    require(
        read_clicks(ConfigNode::parse(text, "written.yaml")).clicks.size() == clicked.clicks.size(),
        "no click is lost");
  });
  if (!read) throw ConfigError("neither a pose nor clicks");
}

}  // namespace hypotrack::fuzz
