#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace hypotrack {

/// What one camera saw, as it came from the sensor (distorted, unrectified).
struct View {
  cv::Mat color;  ///< 8-bit BGR, the size of its camera
  cv::Mat mask;   ///< 8-bit foreground (non-zero) of the same size; empty if unknown
};

/// Where a source knows the answer. Either part may be missing.
struct GroundTruth {
  Eigen::VectorXd state;       ///< state of the scene (size 0: unknown)
  Eigen::Matrix3Xd landmarks;  ///< world positions in the order of Scene::landmark_names(), metres;
                               ///< NaN columns are unknown (size 0: use `state`)
};

/// One moment of a recording.
struct Frame {
  int index = 0;            ///< number within the source, counting missing frames
  double time = 0;          ///< seconds since the first frame
  std::vector<View> views;  ///< one per camera of the source; empty if the frame is unusable
  std::optional<GroundTruth> truth;
  std::string problem;  ///< why `views` is empty (missing file, damaged image), otherwise empty
};

}  // namespace hypotrack
