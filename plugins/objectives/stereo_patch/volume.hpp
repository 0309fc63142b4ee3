#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hypotrack/observation.hpp"
#include "hypotrack/stereo_pixels.hpp"
#include "hypotrack/view_pixels.hpp"
#include "planes.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

/// Similarity of the patches around every pixel of the reference view and its counterparts at the
/// depths of the planes: what makes scoring one lookup per pixel. A word holds the similarity at a
/// plane (low half) and at the next (high half) as 16-bit fractions. Order: row, plane, column.
struct Volume {
  Planes planes;
  int width = 0, height = 0;
  /// What a pixel counts: 0 outside of the image and of the mask, otherwise share_of() the frame.
  /// Its similarities are times this.
  PixelPlane<float> weight;
  PixelPlane<float> uncovered;  ///< residuals of pixels that nothing covers: the root of weight
  std::vector<std::uint32_t> words;

  std::size_t row_stride() const {
    return static_cast<std::size_t>(planes.count) * static_cast<std::size_t>(width);
  }
  const std::uint32_t* row(int y) const {
    return words.data() + static_cast<std::size_t>(y) * row_stride();
  }
};

/// Fills a volume for the first two views of a frame (checked: observation_checks.hpp). The second
/// view is resampled (bilinear) as every plane, parallel to the first tile's, would show it there,
/// then compared patch by patch. A patch that reaches out of a tile or onto invalid pixels has
/// similarity 0, and so do pixels outside the first view's mask, if `use_mask`. SIMD, for the best
/// instruction set that this machine (or hwy::SetSupportedTargetsForTest) offers; they differ by
/// rounding only.
void make_volume(const Observation& observation, const Settings& settings, Volume& volume);

}  // namespace hypotrack::stereo_patch
