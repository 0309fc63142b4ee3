#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "geometry/distortion.hpp"
#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack {

/// For every pixel of a tile, and one more on each side, where it lies in the image.
struct ImageMap {
  cv::Mat x, y;      ///< 32-bit float, (size + 2)^2; far outside where the camera cannot see
  double scale = 1;  ///< image pixels per tile pixel at the centre (square root of the area ratio)
};

/// How a reduction keeps the image from aliasing: the mean over blocks x blocks image pixels, then
/// samples x samples bilinear lookups per tile pixel.
struct ReductionPlan {
  int blocks = 1;
  int samples = 1;
};

/// Plain bilinear lookup up to a reduction of 1.15; from there on the lookups of a pixel lie at
/// most 1.15 image pixels (or blocks) apart, so that every image pixel counts.
HYPOTRACK_API ReductionPlan plan_reduction(double scale);

/// Takes tiles out of one camera's images: lens, rotation, crop and scale in one lookup.
class HYPOTRACK_API Resampler {
 public:
  Resampler(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal);

  /// The map of a tile; only the intrinsics of the tile camera are looked at.
  ImageMap map(const TileCamera& tile) const;

  /// Validity, and what the view has of colour, mask and depth, of a tile. `view` is of the
  /// camera's size. Colour outside the image continues its border, so that no edge appears there;
  /// depth is that of the nearest pixel, along the tile's optical axis, and 0 outside.
  TileView cut(const View& view, const TileCamera& tile, const ImageMap& map,
               const ReductionPlan& plan) const;

 private:
  Camera camera_;
  Eigen::Matrix3f camera_from_ideal_;
  std::array<float, 8> distortion_;
  float largest_r2_;
};

}  // namespace hypotrack
