#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/types.hpp>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// Pixels by which a face's picture reaches over its edges, so that filtering mixes in no other.
inline constexpr double kFaceMargin = 2;

/// The rectangles of a box's faces in its texture, in pixels: +x, -x, +y, -y, +z, -z.
struct BoxLayout {
  cv::Size image;
  std::array<cv::Rect2d, 6> faces;
};

/// Returns a layout in proportion: all faces have the same pixels per millimetre, about ten on a
/// box the size of a hand.
BoxLayout layout_in_proportion(const Eigen::Vector3d& size);

/// Returns a layout that gives every face the same picture of this size, stretched to fit.
BoxLayout layout_of_pictures(const cv::Size& picture);

/// Makes a box of the given edge lengths (metres) about the origin: 8 vertices, 12 triangles, and
/// the texture coordinates of a layout.
Mesh box_mesh(const Eigen::Vector3d& size, const BoxLayout& layout);

/// Makes a texture for a layout in proportion: print-like, different on every face, deterministic
/// in the seed. Objects of one colour cannot be tracked by comparing colours.
cv::Mat box_pattern(const BoxLayout& layout, int seed);

/// Makes a texture with the same picture on every face, for layout_of_pictures() of its size.
cv::Mat repeat_on_faces(const cv::Mat& picture);

}  // namespace hypotrack
