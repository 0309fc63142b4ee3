#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/observation.hpp"
#include "tile/cut_plan.hpp"

namespace hypotrack {

/// For every pixel of a tile, and one more on each side, where it lies in the image.
struct ImageMap {
  cv::Mat x, y;  ///< 32-bit float, (size + 2)^2; far outside where the camera cannot see
};

/// Colours (8-bit BGR), brighter by a number per pixel (32-bit float); empty: by nothing.
HYPOTRACK_API cv::Mat brightened(const cv::Mat& color, const cv::Mat& by);

/// Takes tiles out of one camera's images: lens, rotation, crop and scale in one lookup.
class HYPOTRACK_API Resampler {
 public:
  Resampler(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal);

  const LensMap& lens() const { return lens_; }
  cv::Size image_size() const { return image_; }

  /// The map of a tile; only the intrinsics of the tile camera are looked at.
  ImageMap map(const TileCamera& tile) const;

  /// Validity, and what the view has of colour, mask and depth, of a tile. `view` is of the
  /// camera's size. Colour outside the image continues its border, so that no edge appears there;
  /// depth is that of the nearest pixel, along the tile's optical axis, and 0 outside.
  TileView cut(const View& view, const TileCamera& tile, const CutPlan& plan) const;

 private:
  LensMap lens_;
  cv::Size image_;
};

}  // namespace hypotrack
