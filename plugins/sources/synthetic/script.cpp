#include "script.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/error.hpp"
#include "hypotrack/params.hpp"
#include "hypotrack/pose.hpp"

namespace hypotrack::synthetic {
namespace {

constexpr int kPoseLength = 7;

struct KeyframeParams {
  std::optional<double> time;
  std::optional<int> frame;
  ConfigNode gesture, pose;
  void visit(ParamVisitor& v) {
    v("time", time, {.help = "moment of the keyframe", .min = 0, .max = 1e6, .unit = "s"});
    v("frame", frame, {.help = "instead of time: number of the frame", .min = 0});
    v("gesture", gesture, {.help = "name of a gesture, or a map of models to gestures"});
    v("pose", pose, {.help = "map of models to position_mm, rotation_deg, quaternion, angles_deg"});
  }
};

/// A gesture as written: patterns and angles, in order.
struct GestureParams {
  struct Entry {
    std::string pattern;
    double angle = 0;
  };
  std::vector<Entry> entries;
  void visit(ParamVisitor& v) {
    for (Entry& e : entries) {
      v(e.pattern, e.angle, {.help = "joint angle", .unit = "deg", .to_si = kDegree});
    }
  }
};

/// What one keyframe says.
struct Keys {
  std::map<int, double> numbers;                        // by parameter of the scene
  std::map<std::size_t, Eigen::Quaterniond> rotations;  // by model
};

std::string joined(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<std::string> angle_names(const Model& model) {
  std::vector<std::string> names;
  for (const Parameter& p : model.data().parameters) {
    if (p.kind == ParameterKind::angle) names.push_back(p.name);
  }
  return names;
}

class ScriptReader {
 public:
  ScriptReader(const ConfigNode& gestures, const Scene& scene)
      : gestures_(gestures), scene_(scene) {
    if (gestures.defined() && !gestures.is_map()) {
      throw ConfigError(gestures.where() + ": expected a map of gesture names to angles");
    }
  }

  Keys read(const KeyframeParams& keyframe) const {
    Keys keys;
    if (keyframe.gesture.is_scalar()) {
      for (const Scene::Item& item : scene_.items()) {
        if (item.model->dimension() > kPoseLength) apply_gesture(keyframe.gesture, item, keys);
      }
    } else if (keyframe.gesture.defined()) {
      apply_gestures(keyframe.gesture, keys);
    }
    if (keyframe.pose.defined()) apply_pose(keyframe.pose, keys);
    return keys;
  }

 private:
  void apply_gestures(const ConfigNode& by_model, Keys& keys) const {
    if (!by_model.is_map()) {
      throw ConfigError(by_model.where() +
                        ": expected the name of a gesture or a map of models to gestures");
    }
    for (const std::string& name : by_model.keys()) {
      const ConfigNode gesture = by_model.get(name);
      const Scene::Item* found = nullptr;
      std::vector<std::string> known;
      for (const Scene::Item& item : scene_.items()) {
        if (item.name == name) found = &item;
        known.push_back(item.name);
      }
      if (!found) {
        throw ConfigError(fmt::format("{}: '{}' is no model of this scene; its models are: {}",
                                      gesture.where(), name, joined(known)));
      }
      if (!gesture.is_scalar()) {
        throw ConfigError(gesture.where() + ": expected the name of a gesture");
      }
      apply_gesture(gesture, *found, keys);
    }
  }

  void apply_gesture(const ConfigNode& name, const Scene::Item& item, Keys& keys) const {
    const std::vector<Parameter>& parameters = item.model->data().parameters;
    std::vector<double> angles;
    for (const Parameter& p : parameters) angles.push_back(p.rest);
    std::vector<std::string> said(parameters.size());  // the pattern that set an angle
    const ConfigNode gesture = gestures_.get(name.scalar());
    if (gesture.defined()) {
      for (const auto& [pattern, angle] : entries_of(gesture).entries) {
        bool used = false;
        for (std::size_t i = kPoseLength; i < parameters.size(); ++i) {
          if (fnmatch(pattern.c_str(), parameters[i].name.c_str(), 0) != 0) continue;
          angles[i] = angle;
          said[i] = pattern;
          used = true;
        }
        if (!used) {
          throw ConfigError(fmt::format("{}: no joint angle of '{}' is called '{}'; there are: {}",
                                        gesture.get(pattern).where(), item.name, pattern,
                                        joined(angle_names(*item.model))));
        }
      }
    } else if (name.scalar() != "rest") {
      throw ConfigError(fmt::format("{}: no gesture is called '{}'; there are: {}", name.where(),
                                    name.scalar(), known_gestures()));
    }
    for (std::size_t i = kPoseLength; i < parameters.size(); ++i) {
      check_bounds(name, gesture.get(said[i]), parameters[i], angles[i]);
      keys.numbers[item.offset + static_cast<int>(i)] = angles[i];
    }
  }

  static GestureParams entries_of(const ConfigNode& gesture) {
    if (!gesture.is_map()) {
      throw ConfigError(gesture.where() + ": expected a map of joint angles to degrees");
    }
    GestureParams params;
    for (const std::string& pattern : gesture.keys()) params.entries.push_back({pattern, 0});
    return ParamReader(gesture).read(std::move(params));
  }

  static void check_bounds(const ConfigNode& gesture, const ConfigNode& entry, const Parameter& p,
                           double angle) {
    constexpr double kSlack = 1e-6;
    if (angle >= p.lower - kSlack && angle <= p.upper + kSlack) return;
    throw ConfigError(fmt::format(
        "{}: gesture '{}' turns '{}' to {:.6g} deg, but the model allows {:.6g} to {:.6g}",
        entry.where(), gesture.scalar(), p.name, angle / kDegree, p.lower / kDegree,
        p.upper / kDegree));
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
      for (std::size_t i = kPoseLength; i < parameters.size(); ++i) {
        const int index = item.offset + static_cast<int>(i);
        if (said.get("angles_deg").get(parameters[i].name).defined()) {
          keys.numbers[index] = state[index];
        }
      }
    }
  }

  std::string known_gestures() const {
    std::vector<std::string> names = {"rest"};
    for (const std::string& name : gestures_.keys()) names.push_back(name);
    return joined(names);
  }

  const ConfigNode& gestures_;
  const Scene& scene_;
};

double time_of(const KeyframeParams& keyframe, const ConfigNode& node, double frame_rate) {
  if (keyframe.time.has_value() == keyframe.frame.has_value()) {
    throw ConfigError(node.where() + ": a keyframe needs either `time` (seconds) or `frame`");
  }
  return keyframe.time ? *keyframe.time : *keyframe.frame / frame_rate;
}

void check_positions(const ConfigNode& keyframes, const Scene& scene, const Motion& motion) {
  for (const Scene::Item& item : scene.items()) {
    if (motion.has_number(item.offset)) continue;
    throw ConfigError(fmt::format(
        "{}: no keyframe says where '{}' is; give `pose: {{{}: {{position_mm: [x, y, z]}}}}` "
        "in the first one",
        keyframes.where(), item.name, item.name));
  }
}

}  // namespace

Script read_script(const ConfigNode& keyframes, const ConfigNode& gestures, const Scene& scene,
                   double frame_rate) {
  if (!keyframes.is_list() || keyframes.size() == 0) {
    throw ConfigError(keyframes.where() + ": expected a list of at least one keyframe");
  }
  const ScriptReader reader(gestures, scene);
  Script script{Motion(scene), -1};
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const ConfigNode node = keyframes.at(i);
    const auto keyframe = ParamReader(node).read<KeyframeParams>();
    const double time = time_of(keyframe, node, frame_rate);
    if (time <= script.duration) {
      throw ConfigError(
          fmt::format("{}: this keyframe is at {:.6g} s, the one before it at {:.6g} s; "
                      "times must ascend",
                      node.where(), time, script.duration));
    }
    script.duration = time;
    const Keys keys = reader.read(keyframe);
    for (const auto& [parameter, value] : keys.numbers) {
      script.motion.add_number(parameter, time, value);
    }
    for (const auto& [model, rotation] : keys.rotations) {
      script.motion.add_rotation(model, time, rotation);
    }
  }
  check_positions(keyframes, scene, script.motion);
  return script;
}

}  // namespace hypotrack::synthetic
