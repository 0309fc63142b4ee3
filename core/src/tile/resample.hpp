#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "tile/resample_plan.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Image positions of all pixels of a tile and a margin of one pixel.
struct ImageMap {
  cv::Mat x, y;          ///< 32-bit float, (size + 2)^2; far outside where the camera cannot see
  bool is_grid = false;  ///< the rows of x are equal, and the columns of y
};

/// Adds a brightness per pixel (32-bit float) to an image (8-bit BGR). An empty `by` adds nothing.
cv::Mat brightened(const cv::Mat& color, const cv::Mat& by);

/// Resamples tiles from one camera's images: lens, rotation, crop and scale in one lookup.
class Resampler {
 public:
  Resampler(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal);

  const LensMap& lens() const { return lens_; }
  cv::Size image_size() const { return image_; }

  /// Returns the map of a tile; it uses only the intrinsics of the tile camera.
  ImageMap map(const TileCamera& tile) const;

  /// Resamples a tile's validity and the colour, mask and depth that the view has. `view` has the
  /// camera's size. Colour outside the image repeats its border, so that no edge appears there.
  /// Depth comes from the nearest pixel, along the tile's optical axis, and is 0 outside.
  TileView resample(const View& view, const TileCamera& tile, const ResamplePlan& plan) const;

  /// Resamples the part of a background that the plan touches (8-bit BGRA) as `resample` does
  /// colours. Alpha is 255 where all of a tile pixel's neighbours are known, otherwise 0.
  cv::Mat resample_background(const cv::Mat& touched, const TileCamera& tile,
                              const ResamplePlan& plan) const;

 private:
  LensMap lens_;
  cv::Size image_;
};

}  // namespace internal
}  // namespace hypotrack
