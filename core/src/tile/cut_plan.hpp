#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "camera/lens_map.hpp"
#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/observation.hpp"
#include "tile/color_map.hpp"

namespace hypotrack {

/// How a reduction keeps the image from aliasing: the mean over blocks x blocks image pixels, then
/// samples x samples bilinear lookups per tile pixel.
struct ReductionPlan {
  int blocks = 1;
  int samples = 1;
};

/// What taking a tile out of an image needs to know beside the tile's camera.
struct CutPlan {
  ReductionPlan reduction;
  /// The part of the image that the lookups touch, in whole blocks counted from the image's corner.
  /// Lookups elsewhere take its nearest pixel. The image's last pixels that fill no block are left
  /// out.
  cv::Rect touched;
  /// Applied to the tile's colours; identity from plan_cut().
  ColorMap colors;
  /// Added to every channel after that, 0 .. 255 (32-bit float, of the tile's size); empty from
  /// plan_cut(): nothing. Only Resampler::cut() does this.
  cv::Mat brightness;
};

/// `camera_from_ideal` is a rotation.
HYPOTRACK_API LensMap make_lens_map(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal);
HYPOTRACK_API TileIntrinsics intrinsics(const TileCamera& tile);

/// Image pixels per tile pixel at the tile's centre (square root of the area ratio).
HYPOTRACK_API double scale_at_centre(const LensMap& map, const TileCamera& tile);

/// Plain bilinear lookup up to a reduction of 1.15; from there on the lookups of a pixel lie at
/// most 1.15 image pixels (or blocks) apart, so that every image pixel counts.
HYPOTRACK_API ReductionPlan plan_reduction(double scale);

/// The plan of a tile that is `scale` image pixels per tile pixel, in an image of a given size.
/// Looks at a few pixels of the tile only: lenses are smooth.
HYPOTRACK_API CutPlan plan_cut(const LensMap& map, const TileCamera& tile, cv::Size image,
                               double scale);

}  // namespace hypotrack
