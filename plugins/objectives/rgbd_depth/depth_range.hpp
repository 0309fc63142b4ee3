#pragma once

#include <Eigen/Core>

#include "foreground-inl.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::rgbd_depth {

/// Returns the range of the posed scene's depths in a camera, widened by `margin` metres at both
/// ends.
DepthRange depth_range(const Scene& scene, const Eigen::VectorXd& state, const TileCamera& camera,
                       double margin);

}  // namespace hypotrack::rgbd_depth
