#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

/// Similarities of the patches around every pixel of the reference view and its counterparts at the
/// planes' depths, so that scoring is one lookup per pixel. A word holds the similarity at a plane
/// (low half) and at the next (high half) as 16-bit fractions. Order: row, plane, column.
struct Volume {
  Planes planes;
  int width = 0, height = 0;
  /// Weight of each pixel: 0 outside the image or the mask, otherwise share_of() the frame.
  /// Multiplies its similarities.
  PixelPlane<float> weight;
  PixelPlane<float> uncovered;  ///< residuals of uncovered pixels: the root of weight
  std::vector<std::uint32_t> words;

  std::size_t row_stride() const {
    return static_cast<std::size_t>(planes.count) * static_cast<std::size_t>(width);
  }
  const std::uint32_t* row(int y) const {
    return words.data() + static_cast<std::size_t>(y) * row_stride();
  }
};

/// Fills a volume for the first two views of a frame (checked: objective.hpp). Warps the
/// second view by every plane parallel to the first tile (bilinear), then compares patch by patch.
/// The similarity is 0 for patches that extend beyond a tile or onto invalid pixels and, with
/// `use_mask`, for pixels outside the first view's mask. Uses the best SIMD instruction set of this
/// machine (or hwy::SetSupportedTargetsForTest); they differ by rounding only.
void make_volume(const Observation& observation, const Settings& settings, Volume& volume);

/// Converts a tile to grey in 0..1, with `margin` columns before and behind each row. Invalid
/// pixels and margins are NaN, so that every sum over such a pixel is NaN.
PixelPlane<float> gray_tile(const TileView& view, int margin);

}  // namespace hypotrack::stereo_patch
