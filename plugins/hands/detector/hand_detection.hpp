#pragma once

#include <vector>

#include "hand_points.hpp"

namespace hypotrack {

/// A hand that was found in a picture.
struct HandDetection {
  HandPoints landmarks;
  double palm_score = 0;  ///< of the palm's box, 0 to 1; that of HandDetector::refine() is 1
  double presence = 0;    ///< probability that there is a hand
  double right = 0;       ///< probability that it is a right hand, if the picture is not mirrored
  /// Shape of the hand in metres, about its own centre: x to the picture's right, y down, z away
  /// from the camera. The size is that of an average hand.
  HandPoints3D relative;
};

}  // namespace hypotrack

namespace hypotrack::hands {

/// Adds a hand. If it is one that is already there, the surer of the two stays, at its place.
void add_or_merge(std::vector<HandDetection>& hands, const HandDetection& hand);

/// Moves the network's landmarks (2x21 or 3x21) to the joints and fingertips of hypotrack's hands.
/// The network puts the wrist nearer to the fingers, the thumb's base beside its joint, and tips
/// short of the fingers' ends.
HandPoints joints_of(const HandPoints& landmarks);
HandPoints3D joints_of(const HandPoints3D& landmarks);

/// Moves joints and fingertips to where the network would put its landmarks: undoes joints_of().
HandPoints landmarks_at(const HandPoints& joints);

}  // namespace hypotrack::hands
