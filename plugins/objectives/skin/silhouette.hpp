#pragma once

#include <opencv2/core/mat.hpp>

#include "hypotrack/observation.hpp"

namespace hypotrack::skin {

/// The pixels of a tile that a scene covers in a state: 255, others 0.
cv::Mat1b silhouette(const Scene& scene, const Eigen::VectorXd& state, const TileCamera& camera);

}  // namespace hypotrack::skin
