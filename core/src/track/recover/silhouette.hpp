#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Draws the silhouettes of the flagged models into a picture that is reduced by an integer factor:
/// 255 inside. Leaves out triangles that reach behind the camera.
cv::Mat1b silhouettes(const Scene& scene, const std::vector<bool>& models,
                      const Eigen::VectorXd& state, const Camera& camera, int reduction);

}  // namespace internal
}  // namespace hypotrack
