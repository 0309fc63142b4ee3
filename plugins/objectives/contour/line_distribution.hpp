#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>

namespace hypotrack::contour {

inline constexpr int kSteps = 12;   ///< places of the outline on a line, one segment apart
inline constexpr int kSupport = 8;  ///< segments about a place that say whether it is there
inline constexpr int kSegments = kSteps + kSupport - 1;

/// A number for each segment of a line, from inside the model outwards. The outline is expected in
/// the middle.
using Segments = std::array<float, kSegments>;

/// Returns the distance of a segment from the middle of its line, in segments.
inline float from_middle(int segment) {
  return static_cast<float>(segment) - static_cast<float>(kSegments - 1) / 2;
}

/// Where along a line the outline is, in segments from its middle, outwards.
struct Place {
  float mean;
  float variance;
};

/// Returns the distribution of the outline's place. `likeness` has, for each segment, twice the
/// probability that it shows the model, less 1. Across the outline the expected probability falls
/// as a smoothed step (SRT3D, equation 4).
Place find_place(const Segments& likeness);

/// Refines the outline's place on a line of one-pixel segments. Pixels on the outline show a
/// mixture of both sides, which histograms take for background: a plain box then looks smaller by
/// a third of a pixel. So the share of the model in each pixel is found between the line's mean
/// colours on both sides of `place`. Lines of little contrast stay as they are. Where both ways
/// disagree, the variance grows.
/// `middle` is the line's middle in the image (BGR, 0 to 255), `normal` points outwards.
Place refine_place(const Place& place, const cv::Mat4f& color, const Eigen::Vector2f& middle,
                   const Eigen::Vector2f& normal);

}  // namespace hypotrack::contour
