#include "script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
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
  ConfigNode gesture, pose, hold;
  std::vector<std::string> release;
  void visit(ParamVisitor& v) {
    v("time", time, {.help = "moment of the keyframe", .min = 0, .max = 1e6, .unit = "s"});
    v("frame", frame, {.help = "instead of time: number of the frame", .min = 0});
    v("gesture", gesture, {.help = "name of a gesture, or a map of models to gestures"});
    v("pose", pose, {.help = "map of models to position_mm, rotation_deg, quaternion, angles_deg"});
    v("hold", hold, {.help = "map of models to the model that holds them from now on"});
    v("release", release, {.help = "models that are no longer held"});
  }
};

/// What one keyframe says.
struct Keys {
  ConfigNode node;
  double time = 0;
  std::map<int, double> numbers;                        // by parameter of the scene
  std::map<std::size_t, Eigen::Quaterniond> rotations;  // by model
  std::map<std::size_t, std::size_t> holds;             // holder by held model
  std::vector<std::size_t> releases;
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
        if (item.model->dimension() > kPoseLength) apply_gesture(keyframe.gesture, item, keys);
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

  /// Place of a model in the scene.
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
    const std::vector<double> parameters = gestures_.parameters(name, item);
    for (std::size_t i = kPoseLength; i < parameters.size(); ++i) {
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
      for (std::size_t i = kPoseLength; i < parameters.size(); ++i) {
        const int index = item.offset + static_cast<int>(i);
        if (said.get("angles_deg").get(parameters[i].name).defined()) {
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

std::vector<Keys> read_keyframes(const ConfigNode& keyframes, const KeyframeReader& reader) {
  if (!keyframes.is_list() || keyframes.size() == 0) {
    throw ConfigError(keyframes.where() + ": expected a list of at least one keyframe");
  }
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

/// A model's place: its hold, if any, and its pose keys from keyframe to keyframe.
class WayReader {
 public:
  WayReader(const Scene& scene, const std::vector<Keys>& all, Motion& motion)
      : scene_(scene), all_(all), motion_(motion) {}

  void read(std::size_t model) {
    begun_ = nullptr;
    for (const Keys& keys : all_) {
      if (begun_) end_hold(model, keys);
      add_pose(model, keys);
      const auto hold = keys.holds.find(model);
      if (hold == keys.holds.end()) continue;
      check_holder(model, hold->second, keys);
      begun_ = &keys;
    }
    if (begun_)
      motion_.add_hold(model, begun_->holds.at(model), begun_->time,
                       std::numeric_limits<double>::infinity());
  }

 private:
  const std::string& name(std::size_t model) const { return scene_.items()[model].name; }
  bool released(std::size_t model, const Keys& keys) const {
    return std::find(keys.releases.begin(), keys.releases.end(), model) != keys.releases.end();
  }

  void end_hold(std::size_t model, const Keys& keys) {
    const int offset = scene_.items()[model].offset;
    if (keys.numbers.contains(offset) || keys.rotations.contains(model)) {
      throw ConfigError(
          fmt::format("{}: '{}' is held by '{}' here, which says where it is; give its pose later",
                      keys.node.where(), name(model), name(begun_->holds.at(model))));
    }
    if (!released(model, keys)) return;
    motion_.add_hold(model, begun_->holds.at(model), begun_->time, keys.time);
    begun_ = nullptr;
  }

  void add_pose(std::size_t model, const Keys& keys) {
    const int offset = scene_.items()[model].offset;
    for (int i = offset; i < offset + kPoseLength; ++i) {
      const auto number = keys.numbers.find(i);
      if (number != keys.numbers.end()) motion_.add_number(i, keys.time, number->second);
    }
    const auto rotation = keys.rotations.find(model);
    if (rotation != keys.rotations.end()) {
      motion_.add_rotation(model, keys.time, rotation->second);
    }
  }

  void check_holder(std::size_t model, std::size_t holder, const Keys& keys) const {
    if (begun_)
      throw ConfigError(fmt::format("{}: '{}' is held already; `release: [{}]` first",
                                    keys.node.where(), name(model), name(model)));
    for (const Keys& other : all_) {
      if (holder != model && !other.holds.contains(holder)) continue;
      throw ConfigError(fmt::format(
          "{}: '{}' cannot hold '{}': what holds must not be held itself, now or at another time",
          keys.node.where(), name(holder), name(model)));
    }
  }

  const Scene& scene_;
  const std::vector<Keys>& all_;
  Motion& motion_;
  const Keys* begun_ = nullptr;  // where the hold that lasts began
};

void check_releases(const Scene& scene, const std::vector<Keys>& all) {
  std::vector<bool> held(scene.items().size());
  for (const Keys& keys : all) {
    for (const std::size_t model : keys.releases) {
      if (!held[model])
        throw ConfigError(fmt::format("{}: '{}' is not held here and cannot be released",
                                      keys.node.where(), scene.items()[model].name));
      held[model] = false;
    }
    for (const auto& [model, holder] : keys.holds) held[model] = true;
  }
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

Motion make_motion(const Scene& scene, const std::vector<Keys>& all) {
  Motion motion(scene);
  for (const Scene::Item& item : scene.items()) {
    for (const Keys& keys : all) {
      for (int i = item.offset + kPoseLength; i < item.offset + item.model->dimension(); ++i) {
        const auto number = keys.numbers.find(i);
        if (number != keys.numbers.end()) motion.add_number(i, keys.time, number->second);
      }
    }
  }
  check_releases(scene, all);
  std::vector<bool> ever_held(scene.items().size());
  for (const Keys& keys : all)
    for (const auto& [model, holder] : keys.holds) ever_held[model] = true;
  WayReader ways(scene, all, motion);
  for (const bool held : {false, true})  // holders first
    for (std::size_t m = 0; m < ever_held.size(); ++m)
      if (ever_held[m] == held) ways.read(m);
  return motion;
}

}  // namespace

Script read_script(const ConfigNode& keyframes, const Gestures& gestures, const Scene& scene,
                   double frame_rate) {
  const std::vector<Keys> all =
      read_keyframes(keyframes, KeyframeReader(gestures, scene, frame_rate));
  Script script{make_motion(scene, all), all.back().time};
  check_positions(keyframes, scene, script.motion);
  return script;
}

}  // namespace hypotrack::synthetic
