#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "hypotrack/model.hpp"

namespace hypotrack::synthetic {

// Things to look at, as meshes for rigid_model().

/// A rectangle in the plane z = `distance` whose texture (8-bit BGR) is upright for the cameras.
Mesh make_wall(const Eigen::AlignedBox2d& box, double distance, cv::Mat texture);

/// A box of random size about `center`, turned, all six faces with the same pattern.
Mesh make_clutter_box(cv::RNG& random, const Eigen::Vector3d& center);

/// Smooth noise of all scales in three channels about a colour, 8-bit BGR, `size` pixels square.
cv::Mat make_pattern(cv::RNG& random, int size);

}  // namespace hypotrack::synthetic
