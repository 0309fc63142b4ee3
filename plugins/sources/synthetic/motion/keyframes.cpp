#include "motion/keyframes.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/pose.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::synthetic {
namespace {

struct KeyframeParams {
  std::optional<double> time;
  std::optional<int> frame;
  ConfigNode gesture, pose, hold;
  std::vector<std::string> release;
  void visit(ParamVisitor& v) {
    v("time", time, {.help = "moment of the keyframe", .min = 0, .max = 1e6, .unit = "s"});
    v("frame", frame, {.help = "instead of time: number of the frame", .min = 0});
    v("gesture", gesture, {.help = "name of a gesture, or a map of models to gestures"});
    v("pose", pose,
      {.help = "map of models to position_mm, rotation_deg, quaternion, rotation, "
               "angles_deg, lengths_mm"});
    v("hold", hold, {.help = "map of models to the model that holds them from now on"});
    v("release", release, {.help = "models that are no longer held"});
  }
};

class KeyframeReader {
 public:
  KeyframeReader(const Gestures& gestures, const Scene& scene, double frame_rate)
      : gestures_(gestures), scene_(scene), frame_rate_(frame_rate) {}

  Keys read(const ConfigNode& node) const {
    const auto keyframe = ParamReader(node).read<KeyframeParams>();
    Keys keys;
    keys.node = node;
    keys.time = time_of(keyframe, node);
    if (keyframe.gesture.is_scalar()) {
      for (const Scene::Item& item : scene_.items()) {
        if (item.model->dimension() > kPoseSize) apply_gesture(keyframe.gesture, item, keys);
      }
    } else if (keyframe.gesture.defined()) {
      apply_gestures(keyframe.gesture, keys);
    }
    if (keyframe.pose.defined()) apply_pose(keyframe.pose, keys);
    if (keyframe.hold.defined()) apply_holds(keyframe.hold, keys);
    for (const std::string& name : keyframe.release) {
      keys.releases.push_back(model(name, node.get("release")));
    }
    return keys;
  }

 private:
  double time_of(const KeyframeParams& keyframe, const ConfigNode& node) const {
    if (keyframe.time.has_value() == keyframe.frame.has_value()) {
      throw ConfigError(node.where() + ": a keyframe needs either `time` (seconds) or `frame`");
    }
    return keyframe.time ? *keyframe.time : *keyframe.frame / frame_rate_;
  }

  /// Returns the index of a model in the scene.
  std::size_t model(const std::string& name, const ConfigNode& where) const {
    std::vector<std::string> known;
    for (const Scene::Item& item : scene_.items()) {
      if (item.name == name) return known.size();
      known.push_back(item.name);
    }
    throw ConfigError(fmt::format("{}: '{}' is no model of this scene; its models are: {}",
                                  where.where(), name, fmt::join(known, ", ")));
  }

  void apply_gestures(const ConfigNode& by_model, Keys& keys) const {
    if (!by_model.is_map()) {
      throw ConfigError(by_model.where() +
                        ": expected the name of a gesture or a map of models to gestures");
    }
    for (const std::string& name : by_model.keys()) {
      const ConfigNode gesture = by_model.get(name);
      const Scene::Item& item = scene_.items()[model(name, gesture)];
      if (!gesture.is_scalar()) {
        throw ConfigError(gesture.where() + ": expected the name of a gesture");
      }
      apply_gesture(gesture, item, keys);
    }
  }

  void apply_gesture(const ConfigNode& name, const Scene::Item& item, Keys& keys) const {
    const std::vector<double> parameters = gestures_.parameters(name.scalar(), name, item);
    for (std::size_t i = kPoseSize; i < parameters.size(); ++i) {
      keys.numbers[item.offset + static_cast<int>(i)] = parameters[i];
    }
  }

  void apply_pose(const ConfigNode& pose, Keys& keys) const {
    const Eigen::VectorXd state = read_pose(pose, scene_, scene_.rest_state());
    for (std::size_t m = 0; m < scene_.items().size(); ++m) {
      const Scene::Item& item = scene_.items()[m];
      const ConfigNode said = pose.get(item.name);
      if (said.get("position_mm").defined()) {
        for (int axis = 0; axis < 3; ++axis) {
          keys.numbers[item.offset + axis] = state[item.offset + axis];
        }
      }
      if (said.get("rotation_deg").defined() || said.get("quaternion").defined()) {
        const auto q = state.segment<4>(item.offset + 3);
        keys.rotations[m] = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
      }
      const std::vector<Parameter>& parameters = item.model->data().parameters;
      for (std::size_t i = kPoseSize; i < parameters.size(); ++i) {
        const int index = item.offset + static_cast<int>(i);
        const char* key = is_in_metres(parameters[i].kind) ? "lengths_mm" : "angles_deg";
        if (said.get(key).get(parameters[i].name).defined()) {
          keys.numbers[index] = state[index];
        }
      }
    }
  }

  void apply_holds(const ConfigNode& holds, Keys& keys) const {
    if (!holds.is_map()) {
      throw ConfigError(holds.where() + ": expected a map of models to the model that holds them");
    }
    for (const std::string& name : holds.keys()) {
      const ConfigNode holder = holds.get(name);
      if (!holder.is_scalar()) throw ConfigError(holder.where() + ": expected the name of a model");
      keys.holds[model(name, holder)] = model(holder.scalar(), holder);
    }
  }

  const Gestures& gestures_;
  const Scene& scene_;
  double frame_rate_;
};

}  // namespace

std::vector<Keys> read_keyframes(const ConfigNode& keyframes, const Gestures& gestures,
                                 const Scene& scene, double frame_rate) {
  if (!keyframes.is_list() || keyframes.size() == 0) {
    throw ConfigError(keyframes.where() + ": expected a list of at least one keyframe");
  }
  const KeyframeReader reader(gestures, scene, frame_rate);
  std::vector<Keys> all;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    Keys keys = reader.read(keyframes.at(i));
    if (!all.empty() && keys.time <= all.back().time) {
      throw ConfigError(
          fmt::format("{}: this keyframe is at {:.6g} s, the one before it at {:.6g} s; "
                      "times must ascend",
                      keys.node.where(), keys.time, all.back().time));
    }
    all.push_back(std::move(keys));
  }
  return all;
}

}  // namespace hypotrack::synthetic
