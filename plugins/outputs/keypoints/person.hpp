#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hand_points.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/solution.hpp"

namespace hypotrack::keypoints {

/// A hand in one frame.
struct Hand {
  std::string name;
  Status status = Status::tracked;
  bool right = true;
  double confidence = 0;   ///< 0 to 1
  HandPoints3D landmarks;  ///< in the world, metres; NaN: the model has no such landmark
};

/// Returns the probability that a hand's pose is right. Where it is unknown (NaN): 1 if the hand is
/// tracked, 0.5 if not.
double confidence_of(Status status, double probability);

/// Returns a hand as an entry of OpenPose's `people`: name, status, and its 21 keypoints in the
/// world, in the first camera's frame and in pixels of every view. A keypoint is its coordinates
/// and its confidence; all are 0 where it is unknown or behind the camera.
nlohmann::ordered_json person(const Hand& hand, const std::vector<Camera>& cameras);

}  // namespace hypotrack::keypoints
