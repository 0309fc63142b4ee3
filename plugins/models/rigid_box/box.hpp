#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/types.hpp>

#include "hypotrack/model.hpp"

namespace hypotrack {

/// Where the faces of a box lie in its texture, in pixels: +x, -x, +y, -y, +z, -z.
struct BoxLayout {
  cv::Size image;
  std::array<cv::Rect2d, 6> faces;
};

/// A layout in proportion: a millimetre has as many pixels on every face in both directions, about
/// ten on a box the size of a hand.
BoxLayout layout_in_proportion(const Eigen::Vector3d& size);

/// A layout that gives every face the same picture of this size, stretched to fit.
BoxLayout layout_of_pictures(const cv::Size& picture);

/// A box of the given edge lengths (metres) about the origin: 8 vertices, 12 triangles, and the
/// texture coordinates of a layout.
Mesh box_mesh(const Eigen::Vector3d& size, const BoxLayout& layout);

/// A texture for a layout in proportion: print-like, different on every face, the same for the same
/// seed. Bodies of one colour cannot be tracked by comparing colours.
cv::Mat box_pattern(const BoxLayout& layout, int seed);

/// A texture with the same picture on every face, for the layout of its size.
cv::Mat repeat_on_faces(const cv::Mat& picture);

}  // namespace hypotrack
