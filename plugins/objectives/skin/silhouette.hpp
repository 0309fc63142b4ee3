#pragma once

#include <opencv2/core/mat.hpp>

#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::skin {

/// Draws the silhouette of a scene in a state into a tile: 255 inside, 0 outside.
cv::Mat1b silhouette(const Scene& scene, const Eigen::VectorXd& state, const TileCamera& camera);

}  // namespace hypotrack::skin
