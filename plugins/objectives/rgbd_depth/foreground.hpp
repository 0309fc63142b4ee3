#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "hypotrack/observation.hpp"
#include "hypotrack/view_pixels.hpp"
#include "params.hpp"

namespace hypotrack::rgbd_depth {

/// Depths z along a camera's axis, metres.
struct DepthRange {
  double nearest = 0;
  double farthest = 0;
};

/// The depths that the posed scene has for a camera, widened by `margin` metres at both ends.
DepthRange depth_range(const Scene& scene, const Eigen::VectorXd& state, const TileCamera& camera,
                       double margin);

/// Skin by its chrominance: 133 <= Cr <= 173 and 77 <= Cb <= 127 of 8-bit YCrCb (D. Chai, K. N.
/// Ngan, "Face segmentation using skin-color map in videophone applications", IEEE Trans. Circuits
/// and Systems for Video Technology 9(4), 1999). 8-bit, non-zero for skin; `bgr` is 8-bit BGR.
cv::Mat skin(const cv::Mat& bgr);

/// What one view observed.
struct ObservedView {
  PixelPlane<float> pixels;     ///< per pixel what observed.hpp says
  std::int64_t foreground = 0;  ///< number of pixels with o_s: measured or not
  std::int64_t measured = 0;    ///< number of those with a depth
};

/// Tells foreground from background in a view with depth. By
///   mask   what the mask says
///   depth  pixels measured within `range`
///   skin   pixels of the colour of skin, unless measured outside `range`
///   auto   mask if the view has one, otherwise depth
/// The view must have what its way needs. Pixels that are not valid are outside.
ObservedView observe(const TileView& view, Foreground foreground, const DepthRange& range);

}  // namespace hypotrack::rgbd_depth
