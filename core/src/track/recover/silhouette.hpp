#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// Draws the silhouettes of some models of a scene into a picture reduced by a whole factor:
/// 255 where one of them is. Leaves out triangles that reach behind the camera.
HYPOTRACK_API cv::Mat1b silhouettes(const Scene& scene, const std::vector<bool>& models,
                                    const Eigen::VectorXd& state, const Camera& camera,
                                    int reduction);

}  // namespace hypotrack
