#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace hypotrack {

/// What one camera saw, as it came from the sensor (distorted, unrectified). Every image that is
/// there has the size of its camera; a view has colour, depth or both.
struct View {
  cv::Mat color{};  ///< 8-bit BGR; empty for a camera that gives depth only
  cv::Mat mask{};   ///< 8-bit foreground (non-zero); empty if unknown
  cv::Mat depth{};  ///< 32-bit float z in metres along the optical axis, 0: not measured; empty for
                    ///< a colour camera
};

/// Where a source knows the answer. Either part may be missing.
struct GroundTruth {
  Eigen::VectorXd state;       ///< state of the scene (size 0: unknown)
  Eigen::Matrix3Xd landmarks;  ///< world positions in the order of Scene::landmark_names(), metres;
                               ///< NaN columns are unknown (size 0: use `state`)
  /// For each model of the scene, whether it is known not to be in any picture; its landmarks are
  /// then NaN. Empty: every model is in view.
  std::vector<bool> absent{};
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
