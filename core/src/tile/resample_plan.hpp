#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "base/exported.hpp"
#include "camera/lens/lens_map.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "tile/color_map.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Antialiasing of a reduction: means over blocks x blocks image pixels, then samples x samples
/// bilinear lookups per tile pixel.
struct ReductionPlan {
  int blocks = 1;
  int samples = 1;
};

/// The parameters of a tile's resampling besides the tile's camera.
struct ResamplePlan {
  ReductionPlan reduction;
  /// The part of the image that the lookups read, in whole blocks from the image's corner. Lookups
  /// outside read its nearest pixel. Trailing pixels of the image that fill no block are excluded.
  cv::Rect touched;
  /// Map of the tile's colours; the identity from plan_resampling().
  ColorMap colors;
  /// Brightness to add to every channel after `colors`, 0 .. 255 (32-bit float, tile size). Empty
  /// from plan_resampling(): adds nothing. Only Resampler::resample() applies it.
  cv::Mat brightness;
  /// Pixels that count as outside the image (8-bit, tile size), because something hides what is
  /// tracked there. Empty from plan_resampling(): none. Only Resampler::resample() applies it.
  cv::Mat hidden;
};

/// Makes the lens map of a camera; `camera_from_ideal` is a rotation.
LensMap make_lens_map(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal);
TileIntrinsics intrinsics(const TileCamera& tile);

/// Returns the image pixels per tile pixel at the tile's centre (square root of the area ratio).
double scale_at_centre(const LensMap& map, const TileCamera& tile);

/// Plans the antialiasing of a reduction. Up to 1.15 image pixels per tile pixel it is a plain
/// bilinear lookup. Above, the lookups lie at most 1.15 image pixels (or blocks) apart, so that
/// every image pixel counts.
ReductionPlan plan_reduction(double scale);

/// Plans a tile with `scale` image pixels per tile pixel. It samples only a few pixels of the tile,
/// because lenses are smooth.
ResamplePlan plan_resampling(const LensMap& map, const TileCamera& tile, cv::Size image,
                             double scale);

}  // namespace internal
}  // namespace hypotrack
