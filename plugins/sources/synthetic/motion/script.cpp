#include "motion/script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "motion/keyframes.hpp"

namespace hypotrack::synthetic {
namespace {

/// Reads a model's holds and its pose keys from keyframe to keyframe.
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
    for (int i = offset; i < offset + kPoseSize; ++i) {
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
  const Keys* begun_ = nullptr;  // keyframe at which the current hold began
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
      for (int i = item.offset + kPoseSize; i < item.offset + item.model->dimension(); ++i) {
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

const Motion& Script::motion_at(double time) const {
  const Motion* now = &motion;
  for (const Jump& jump : jumps)
    if (jump.from <= time) now = &jump.motion;
  return *now;
}

Script read_script(const ConfigNode& keyframes, const Gestures& gestures, const Scene& scene,
                   double frame_rate) {
  const std::vector<Keys> all = read_keyframes(keyframes, gestures, scene, frame_rate);
  Script script{make_motion(scene, all), all.back().time, {}, {}};
  check_positions(keyframes, scene, script.motion);
  return script;
}

}  // namespace hypotrack::synthetic
