#pragma once

#include "hand_detection.hpp"

namespace hypotrack::hands {

/// Moves the network's landmarks (2x21 or 3x21) to the joints and fingertips of hypotrack's hands.
/// The network puts the wrist nearer to the fingers, the thumb's base beside its joint, and tips
/// short of the fingers' ends.
HandPoints joints_of(const HandPoints& landmarks);
HandPoints3D joints_of(const HandPoints3D& landmarks);

/// Moves joints and fingertips to where the network would put its landmarks: undoes joints_of().
HandPoints landmarks_at(const HandPoints& joints);

}  // namespace hypotrack::hands
