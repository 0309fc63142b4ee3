#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/tables.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Speed between consecutive frames.
struct Speed {
  double peak = 0;
  double mean = 0;
  int frame = 0;  ///< later frame of the pair with the peak
};

/// Speeds of one model. A tracker that searches around its last solution has to bridge the peaks.
struct ModelSpeeds {
  std::string model;
  Speed translation;  ///< of the model's origin, metres per frame
  Speed rotation;     ///< angle between the orientations, radians per frame
  Speed joints;       ///< largest change of a joint angle, radians per frame; all 0 without joints
  std::string fastest_joint;  ///< parameter with the peak; empty without joints
  Speed slides;               ///< largest change of a joint's length, metres per frame
  std::string fastest_slide;  ///< parameter with the peak; empty without joints that slide
};

/// Computes the speeds of every model of the scene. `states` must be in ascending order of frames.
/// Pairs of states of non-consecutive frames, or with a gap in time between them, do not count.
std::vector<ModelSpeeds> motion_speeds(const Scene& scene, std::span<const StateRow> states);

/// Returns the text of motion.json: peak, mean and frame of each speed by model, mm and degrees per
/// frame.
std::string motion_json(std::span<const ModelSpeeds> speeds);
/// Returns a readable text with one line per model.
std::string motion_text(std::span<const ModelSpeeds> speeds);

}  // namespace internal
}  // namespace hypotrack
