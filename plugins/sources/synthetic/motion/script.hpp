#pragma once

#include <utility>
#include <vector>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/scene.hpp"
#include "motion/gestures.hpp"
#include "motion/motion.hpp"

namespace hypotrack::synthetic {

struct Script {
  /// A motion that replaces the one before it.
  struct Jump {
    double from = 0;  ///< seconds
    Motion motion;
  };
  Motion motion;
  double duration = 0;                          ///< time of the last frame, seconds
  std::vector<Jump> jumps{};                    ///< ascending
  std::vector<std::pair<int, int>> absences{};  ///< first and last frames without any model

  /// Returns the motion that is in force at a time.
  const Motion& motion_at(double time) const;
  Eigen::VectorXd state(double time) const { return motion_at(time).state(time); }
};

/// Reads `keyframes:` and the gestures they name.
///
///   gestures:
///     fist: {"*_flexion_2": 95, thumb_abduction: 10}   # see Gestures
///   keyframes:
///     - {time: 0, gesture: rest, pose: {hand: {position_mm: [0, 60, 450]}}}
///     - {frame: 40, gesture: {hand: fist}, hold: {box: hand}}
///     - {frame: 80, release: [box]}
///
/// `pose` is as for read_pose(). `gesture` is one for all models with joints, or one per model.
/// Position, rotation and every angle have their own keys: a keyframe does not affect what it does
/// not mention. `hold` names models and their holders: until their `release` they move rigidly with
/// the holder (Motion::add_hold()). Throws ConfigError with file:line:column.
Script read_script(const ConfigNode& keyframes, const Gestures& gestures, const Scene& scene,
                   double frame_rate);

}  // namespace hypotrack::synthetic
