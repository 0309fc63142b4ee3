#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/renderer.hpp"

namespace hypotrack {

/// Where a scene is; `state` or `landmarks` may be unknown.
struct ScenePose {
  Eigen::VectorXd state;       ///< size 0: unknown
  Eigen::Matrix3Xd landmarks;  ///< 3xL, world, metres; NaN columns are unknown
};

/// A piece of `image` (8-bit BGR of the camera's size) around a solution, enlarged, with the
/// solution in orange (tinted and outlined), the truth in blue (outlined), a line from each
/// landmark to where it should be, and a legend under it. `renderer` is one of the scene of both.
/// Throws DataError where Renderer::render does.
HYPOTRACK_API cv::Mat draw_comparison(Renderer& renderer, const cv::Mat& image,
                                      const Camera& camera, const ScenePose& solution,
                                      const ScenePose& truth, const std::string& caption);

}  // namespace hypotrack
