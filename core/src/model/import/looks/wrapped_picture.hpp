#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <utility>

#include "base/exported.hpp"
#include "model/import/wire.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

using Rgb = std::array<std::uint8_t, 3>;
using UvCorners = Eigen::Matrix<float, 2, 3>;  ///< of a triangle, v upwards

/// A part of the plane of texture coordinates with its pixels.
struct PictureWindow {
  cv::Mat3b pixels;
  Eigen::Array2d low = Eigen::Array2d::Zero();   ///< least u and v
  Eigen::Array2d size = Eigen::Array2d::Ones();  ///< extent along u and v
  double shrink = 1;                             ///< pixels per pixel of the picture, along a side

  /// Moves texture coordinates of the plane into the window.
  UvCorners moved(const UvCorners& uv) const;
};

/// A picture that goes on outside [0, 1] as its material says.
class WrappedPicture {
 public:
  WrappedPicture(cv::Mat3b image, const std::array<mesh_wire::Wrap, 2>& wrap)
      : image_(std::move(image)), wrap_(wrap) {}

  const cv::Mat3b& image() const { return image_; }

  /// Moves a triangle near [0, 1], to where the plane looks the same. Rounding errors at the rim of
  /// the picture are clamped.
  UvCorners near_picture(const UvCorners& uv) const;

  /// Returns the colour at a point, BGR from 0 to 255, interpolated between four pixels.
  Eigen::Vector3f at(const Eigen::Vector2f& uv) const;

  /// Returns the picture itself, and what surrounds it up to `low` and `high`. A window of more
  /// than 4096 pixels on a side has a smaller picture.
  PictureWindow window(const Eigen::Array2f& low, const Eigen::Array2f& high) const;

 private:
  cv::Mat3b image_;
  std::array<mesh_wire::Wrap, 2> wrap_;
};

}  // namespace internal
}  // namespace hypotrack
