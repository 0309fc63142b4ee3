#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "hypotrack/camera.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack {

/// How to get a part of a camera's picture from a picture that a pinhole took at the same place.
struct LensView {
  cv::Rect roi;        ///< part of the camera's image; empty if nothing of it is needed
  TileCamera pinhole;  ///< camera to draw with
  cv::Mat map;  ///< 32-bit float x y in `pinhole` for every pixel of `roi`; NaN: no such ray;
                ///< empty for a camera without distortion, where `pinhole` is just that part
  /// Depth and labels, which are not interpolated, are to be drawn this much finer than `pinhole`.
  int geometry_scale = 1;
};

/// Viewing rays of a camera and what follows for drawing with a renderer that knows pinholes only.
class Lens {
 public:
  explicit Lens(const Camera& camera);

  /// Whether this is the lens of a camera (its pose does not matter).
  bool fits(const Camera& camera) const;

  /// The view that shows `extent`, a box in the plane z = 1 (SceneDrawer::extent).
  LensView view(const Eigen::AlignedBox2d& extent,
                const Eigen::Isometry3d& camera_from_world) const;

 private:
  LensView pinhole_view(const Eigen::AlignedBox2d& extent) const;
  LensView distorted_view(const Eigen::AlignedBox2d& extent) const;

  Camera camera_;
  cv::Mat rays_;  // 32-bit float x/z y/z for every pixel, NaN where the model cannot be inverted
};

/// Picks from `source` what `view.map` says: bilinear for colours, zero outside.
cv::Mat sample_linear(const cv::Mat& source, const LensView& view);
/// The same, nearest pixel, from a source geometry_scale times finer: depth and labels. Types:
/// CV_32FC1 or CV_8UC1.
cv::Mat sample_nearest(const cv::Mat& source, const LensView& view);

}  // namespace hypotrack
