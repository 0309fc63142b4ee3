#pragma once

#include <Eigen/Core>
#include <array>

#include "hypotrack/model.hpp"

namespace hypotrack {

/// How many tiles the texture of a box has: columns are the axes x, y, z, the upper row the faces
/// at the positive end, the lower row those at the negative end.
inline constexpr int kBoxColumns = 3;
inline constexpr int kBoxRows = 2;

/// A box of the given edge lengths (metres) about the origin: 8 vertices, 12 triangles, and texture
/// coordinates that give every face a tile of its own.
Mesh box_mesh(const Eigen::Vector3d& size);

/// A texture for box_mesh(): print-like, different on every face, the same for the same seed.
/// Bodies of one colour cannot be tracked by comparing colours.
cv::Mat box_pattern(int seed);

/// A texture with the same picture on every face.
cv::Mat repeat_on_faces(const cv::Mat& picture);

}  // namespace hypotrack
