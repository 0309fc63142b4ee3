#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <vector>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/scene.hpp"
#include "motion/gestures.hpp"

namespace hypotrack::synthetic {

/// The content of one keyframe.
struct Keys {
  ConfigNode node;
  double time = 0;
  std::map<int, double> numbers;                        // by parameter of the scene
  std::map<std::size_t, Eigen::Quaterniond> rotations;  // by model
  std::map<std::size_t, std::size_t> holds;             // holder by held model
  std::vector<std::size_t> releases;
};

/// Reads the list of keyframes (script.hpp), one by one. Throws ConfigError with file:line:column.
std::vector<Keys> read_keyframes(const ConfigNode& keyframes, const Gestures& gestures,
                                 const Scene& scene, double frame_rate);

}  // namespace hypotrack::synthetic
