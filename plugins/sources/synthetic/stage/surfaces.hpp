#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack::synthetic {

// Background objects as meshes for rigid_model().

/// Makes a rectangle in the plane z = `distance`, whose texture (8-bit BGR) is upright for the
/// cameras.
Mesh make_wall(const Eigen::AlignedBox2d& box, double distance, cv::Mat texture);

/// Makes a rotated box of random size about `center`, with the same pattern on all six faces.
Mesh make_clutter_box(cv::RNG& random, const Eigen::Vector3d& center);

/// Makes smooth noise of all scales in three channels about a colour, 8-bit BGR, `size` pixels
/// square.
cv::Mat make_pattern(cv::RNG& random, int size);

}  // namespace hypotrack::synthetic
