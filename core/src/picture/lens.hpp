#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Mapping from a pinhole camera's picture to a part of a real camera's picture.
struct LensView {
  cv::Rect roi;        ///< part of the camera's image; empty if none is needed
  TileCamera pinhole;  ///< camera to draw with, at the same place
  cv::Mat map;  ///< 32-bit float x y in `pinhole` per pixel of `roi`; NaN = no such ray; empty
                ///< without distortion, where `pinhole` is just that part
  /// Factor by which depth and labels, which are not interpolated, are drawn finer than `pinhole`.
  int geometry_scale = 1;
};

/// The viewing rays of a camera; a renderer for pinhole cameras needs them to draw lens distortion.
class LensRays {
 public:
  explicit LensRays(const Camera& camera);

  /// Returns true if this is the lens of a camera; poses may differ.
  bool fits(const Camera& camera) const;

  /// Returns the view that shows `extent`, a box in the plane z = 1 (extent_of).
  LensView view(const Eigen::AlignedBox2d& extent,
                const Eigen::Isometry3d& camera_from_world) const;

 private:
  LensView pinhole_view(const Eigen::AlignedBox2d& extent) const;
  LensView distorted_view(const Eigen::AlignedBox2d& extent) const;

  Camera camera_;
  cv::Mat rays_;  // 32-bit float x/z y/z for every pixel, NaN where the model cannot be inverted
};

/// Returns the camera with every pixel split into scale x scale.
TileCamera finer(TileCamera camera, int scale);

/// Returns the nearest pixel to a position of LensView::map in a picture of a size that is `scale`
/// times finer than the pinhole's, or nothing outside.
std::optional<cv::Point> nearest_pixel(const cv::Point2f& at, int scale, const cv::Size& size);

/// Resamples `source` by `view.map`: bilinear for colours, zero outside.
cv::Mat sample_linear(const cv::Mat& source, const LensView& view);
/// Resamples depth or labels (CV_32FC1 or CV_8UC1) by the nearest pixel. `source` is geometry_scale
/// times finer than the pinhole's picture.
cv::Mat sample_nearest(const cv::Mat& source, const LensView& view);

}  // namespace internal
}  // namespace hypotrack
