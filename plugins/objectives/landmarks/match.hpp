#pragma once

#include <optional>
#include <span>
#include <vector>

#include "seen_hand.hpp"

namespace hypotrack::landmarks {

/// A model's hand, where the search starts, from one camera.
struct WantedHand {
  HandPoints3D
      directions;  ///< unit vectors along the world's axes; NaN: the model has no such point
  bool right = true;
};

/// Returns the detected hand of each model: of its side and near where its search starts, nearest
/// first. No hand is given to two models.
std::vector<std::optional<SeenHand>> match(std::span<const WantedHand> wanted,
                                           std::span<const SeenHand> seen);

/// Returns whether hands lie over each other as a camera sees them: their centres are nearer than
/// half the larger one's apparent size. Detectors mix up their landmarks. False if NaN only.
bool overlap(const HandPoints3D& a, const HandPoints3D& b);

/// Returns whether two detections are of the same hand of a picture.
bool same_hand(const SeenHand& a, const SeenHand& b);

}  // namespace hypotrack::landmarks
