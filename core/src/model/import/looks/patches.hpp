#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

#include "model/import/looks/wrapped_picture.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A triangle whose corners differ in colour.
struct PaintedTriangle {
  std::array<Rgb, 3> colors{};
  const WrappedPicture* picture = nullptr;  ///< which the colours multiply; null: none
  UvCorners uv = UvCorners::Zero();         ///< in the picture
};

/// The place of a triangle's pixels: its corners are in the middle of the upper left, the upper
/// right and the lower left pixel.
struct PatchPlace {
  std::size_t sheet = 0;
  cv::Rect pixels{};
};

/// Pictures of triangles, a rectangle each.
struct Patches {
  std::vector<cv::Mat3b> sheets;
  std::vector<PatchPlace> places;  ///< one per triangle

  /// Returns the texture coordinates of a triangle in its sheet.
  UvCorners corners(std::size_t triangle) const;
};

/// Multiplies the light of a picture by the colours of triangles, whose texture coordinates are in
/// it. Returns false, and leaves the picture as it is, if triangles of different colours share its
/// pixels or have too few of them.
bool paint_over(const std::vector<PaintedTriangle>& triangles, bool linear, cv::Mat3b& picture);

/// Draws triangles. Colours go from corner to corner in light if `linear`, otherwise as a screen
/// shows them; they multiply the light of a picture. Patches have the pixels of their picture, or
/// fewer if all have more than 4 million.
Patches paint(const std::vector<PaintedTriangle>& triangles, bool linear);

}  // namespace internal
}  // namespace hypotrack
