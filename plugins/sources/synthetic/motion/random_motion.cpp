#include "motion/random_motion.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "hypotrack/api/error.hpp"
#include "motion/keyframes.hpp"
#include "motion/random_poses.hpp"

namespace hypotrack::synthetic {
namespace {

class RandomMotion {
 public:
  RandomMotion(const RandomParams& params, const ConfigNode& node, const Gestures& gestures,
               const Scene& scene, const std::vector<Camera>& cameras, double frame_rate)
      : params_(params),
        scene_(scene),
        frame_rate_(frame_rate),
        poses_(params, node, gestures, scene, cameras) {}

  Script draw() {
    const int after = params_.absence ? params_.absence->after : params_.frames;
    Script script{draw_stretch(0, std::min(after, params_.frames)), 0, {}, {}};
    int begun = 0;  // of the stretch
    for (int left = params_.frames - after; left > 0; left -= after) {
      const int vanished = begun + after, absent = draw_absence();
      script.absences.emplace_back(vanished, vanished + absent - 1);
      begun = vanished + absent;
      script.jumps.push_back({begun / frame_rate_, draw_stretch(begun, std::min(after, left))});
    }
    const int in_last = (params_.frames - 1) % after + 1;
    script.duration = (begun + in_last - 1) / frame_rate_;
    return script;
  }

 private:
  int draw_absence() {
    const Eigen::Vector2d& frames = params_.absence->frames;
    return poses_.random().uniform(static_cast<int>(frames[0]), static_cast<int>(frames[1]) + 1);
  }

  /// Draws a motion with everything in view in `count` frames from `first` on.
  Motion draw_stretch(int first, int count) {
    constexpr int kTries = 1000;
    for (int i = 0; i < kTries; ++i) {
      Motion motion = draw_motion(first / frame_rate_, count / frame_rate_);
      bool good = true;
      for (int frame = first; good && frame < first + count; ++frame)
        good = poses_.is_good(motion.state(frame / frame_rate_));
      if (good) return motion;
    }
    poses_.fail();
  }

  /// Draws postures from a moment before `begin`, so that the stretch begins within a movement.
  Motion draw_motion(double begin, double length) {
    std::vector<Eigen::VectorXd> states = {poses_.draw(), poses_.draw()};
    std::vector<double> times = {0, time_between(states[0], states[1])};
    const double ahead = poses_.random().uniform(0.0, times[1]);
    while (times.back() < ahead + length) {
      states.push_back(poses_.draw());
      times.push_back(times.back() + time_between(states[states.size() - 2], states.back()));
    }
    Motion motion(scene_);
    for (std::size_t i = 0; i < states.size(); ++i)
      add_keys(motion, begin - ahead + times[i], states[i], i == 0);
    for (const RandomPoses::Held& held : poses_.held())
      motion.add_hold(held.model, held.holder, begin - ahead,
                      std::numeric_limits<double>::infinity());
    return motion;
  }

  /// Adds keys of everything but the poses of held models, which follow from the first ones.
  void add_keys(Motion& motion, double time, const Eigen::VectorXd& state, bool first) const {
    for (std::size_t m = 0; m < scene_.items().size(); ++m) {
      const Scene::Item& item = scene_.items()[m];
      const bool placed = first || !poses_.is_held(m);
      for (int i = 0; i < item.model->dimension(); ++i)
        if (i >= kPoseSize || (i < 3 && placed))
          motion.add_number(item.offset + i, time, state[item.offset + i]);
      if (placed) motion.add_rotation(m, time, rotation_of(item, state));
    }
  }

  double time_between(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    double time = params_.gesture_time;
    for (const Scene::Item& item : scene_.items()) {
      const double moved = (a.segment<3>(item.offset) - b.segment<3>(item.offset)).norm();
      const double turned = rotation_of(item, a).angularDistance(rotation_of(item, b));
      time = std::max({time, moved / params_.speed, turned / params_.turn});
    }
    return time * poses_.random().uniform(1.0, 1.5);
  }

  const RandomParams& params_;
  const Scene& scene_;
  double frame_rate_;
  RandomPoses poses_;
};

void check(const RandomParams& params, const ConfigNode& node) {
  if ((params.lowest.array() > params.highest.array()).any())
    throw ConfigError(
        fmt::format("{}: no number of lowest_mm may exceed its one of highest_mm", node.where()));
  if (!params.absence) return;
  const Eigen::Vector2d& frames = params.absence->frames;
  if (frames[0] == std::floor(frames[0]) && frames[1] == std::floor(frames[1]) &&
      frames[0] <= frames[1])
    return;
  throw ConfigError(
      fmt::format("{}: an absence of {:g} to {:g} frames; expected two whole numbers, the least "
                  "first",
                  node.get("absence").get("frames").where(), frames[0], frames[1]));
}

}  // namespace

Script draw_motion(const RandomParams& params, const ConfigNode& node, const Gestures& gestures,
                   const Scene& scene, const std::vector<Camera>& cameras, double frame_rate) {
  check(params, node);
  return RandomMotion(params, node, gestures, scene, cameras, frame_rate).draw();
}

}  // namespace hypotrack::synthetic
