#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Places between two neighbouring pixels each, along one axis of an image. Beyond its border both
/// are the border's pixel.
struct AxisPlaces {
  std::vector<std::int32_t> first, second;
  std::vector<std::int32_t> share;  ///< of the second pixel, in 32nds
};

/// Rounds positions along an axis of `end` pixels to 32nds, as cv::remap() does.
AxisPlaces axis_places(std::span<const float> positions, int end);

/// Interpolates an image (8-bit BGR) at the crossings of columns and rows, and returns the means of
/// samples x samples of them. The result is that of cv::remap() with INTER_LINEAR and
/// BORDER_REPLICATE and of cv::resize() with INTER_AREA, bit by bit. Those take several times as
/// long, because they look up each crossing by itself. The numbers of columns and rows are
/// multiples of `samples`, 1 or 2, and positions do not decrease.
cv::Mat3b look_up_grid(const cv::Mat3b& image, const AxisPlaces& columns, const AxisPlaces& rows,
                       int samples);

}  // namespace internal
}  // namespace hypotrack
