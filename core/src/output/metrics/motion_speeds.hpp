#pragma once

#include <span>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/tables.hpp"

namespace hypotrack {

/// How fast something moves between one frame and the next.
struct Speed {
  double peak = 0;
  double mean = 0;
  int frame = 0;  ///< the later of the two frames with the peak
};

/// Speeds of one model. A tracker that searches around its last solution has to bridge the peaks.
struct ModelSpeeds {
  std::string model;
  Speed translation;  ///< of the model's origin, metres per frame
  Speed rotation;     ///< angle between the orientations, radians per frame
  Speed joints;       ///< largest change of a joint angle, radians per frame; all 0 without joints
  std::string fastest_joint;  ///< parameter with the peak; empty without joints
};

/// Of every model of the scene, over states in ascending order of frames. Pairs of states that are
/// not of consecutive frames do not count.
HYPOTRACK_API std::vector<ModelSpeeds> motion_speeds(const Scene& scene,
                                                     std::span<const StateRow> states);

/// motion.json: peak, mean and frame of each speed by model, mm and degrees per frame.
HYPOTRACK_API std::string motion_json(std::span<const ModelSpeeds> speeds);
/// A line per model for people.
HYPOTRACK_API std::string motion_text(std::span<const ModelSpeeds> speeds);

}  // namespace hypotrack
