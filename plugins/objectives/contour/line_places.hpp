#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

#include "line_distribution.hpp"

namespace hypotrack::contour {

/// The pixels of a view, and how much more probably colours are the model's.
struct RegionPixels {
  cv::Mat4b color;                  ///< blue, green, red, and 0 where the camera has no pixel
  std::span<const float> log_odds;  ///< by bin (ColorHistograms)
};

/// A line of pixels across the outline.
struct PixelLine {
  Eigen::Vector2f middle;
  Eigen::Vector2f normal;  ///< unit, outwards
};

/// Finds the outline's place on lines whose segments are `scale` pixels long. The variance is
/// infinite where most segments just inside show colours that were seen on neither side: something
/// else is before the model.
///
/// Lines of one-pixel segments are refined. Pixels on the outline show a mixture of both sides,
/// which histograms take for background: a plain box then looks smaller by a third of a pixel. So
/// the share of the model in each pixel is found between the line's mean colours on both sides of
/// its place. Lines of little contrast stay as they are. Where both ways disagree, the variance
/// grows.
void find_places(const RegionPixels& pixels, std::span<const PixelLine> lines, int scale,
                 std::span<Place> places);

/// Returns the instruction sets (Highway's bits) that find_places() is compiled for.
std::int64_t compiled_targets();

}  // namespace hypotrack::contour
