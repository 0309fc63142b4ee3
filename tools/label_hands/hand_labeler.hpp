#pragma once

#include <optional>
#include <vector>

#include "hand_detector.hpp"
#include "hand_model.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/tables.hpp"

namespace hypotrack::hands {

/// Labels the hands of a scene in stereo pairs, by a learned detector.
class HandLabeler {
 public:
  /// Reads the networks. Throws ConfigError if the scene has no hand, two hands of one side, or
  /// fewer than two cameras, and DataError as HandDetector does.
  HandLabeler(const Scene& scene, const std::vector<Camera>& cameras);

  /// Returns the frame's landmarks; NaN those of hands that are not trusted.
  LandmarkRow label(const Frame& frame);

  /// Returns for each model in how many frames it was labelled.
  const std::vector<int>& labelled() const { return labelled_; }
  /// Returns whether a model is a hand.
  bool is_hand(std::size_t model) const { return hands_.at(model).has_value(); }

 private:
  const Scene& scene_;
  std::vector<Camera> cameras_;
  std::vector<std::optional<HandModel>> hands_;  ///< by model; nothing: it is no hand
  std::vector<int> labelled_;                    ///< by model
  std::optional<HandDetector> detector_;
};

}  // namespace hypotrack::hands
