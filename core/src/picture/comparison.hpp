#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/renderer.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The state and landmarks of a scene; either may be unknown.
struct ScenePose {
  Eigen::VectorXd state;       ///< size 0 = unknown
  Eigen::Matrix3Xd landmarks;  ///< 3xL, world, metres; NaN columns are unknown
};

/// Draws a solution and the ground truth on an enlarged crop of `image` (8-bit BGR of the camera's
/// size). The solution is orange (tinted and outlined), the truth blue (outlined). Lines lead from
/// landmarks to their true positions; a legend is below. `renderer` must render the scene of both.
/// Throws DataError as Renderer::render does.
cv::Mat draw_comparison(Renderer& renderer, const cv::Mat& image, const Camera& camera,
                        const ScenePose& solution, const ScenePose& truth,
                        const std::string& caption);

}  // namespace internal
}  // namespace hypotrack
