#pragma once

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
