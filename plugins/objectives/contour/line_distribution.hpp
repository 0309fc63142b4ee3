#pragma once

#include <array>
#include <cmath>

namespace hypotrack::contour {

inline constexpr int kSteps = 12;   ///< places of the outline on a line, one segment apart
inline constexpr int kSupport = 8;  ///< segments about a place that say whether it is there
inline constexpr int kSegments = kSteps + kSupport - 1;

/// Returns the distance of a segment from the middle of its line, in segments. Segments follow each
/// other from inside the model outwards; the outline is expected in the middle.
constexpr float from_middle(int segment) {
  return static_cast<float>(segment) - static_cast<float>(kSegments - 1) / 2;
}

/// Where along a line the outline is, in segments from its middle, outwards. `F` is a number, or
/// one per lane.
template <class F>
struct PlaceOf {
  F mean;
  F variance;
};
using Place = PlaceOf<float>;

/// Returns twice the expected probability of the model less 1, for each segment about a place. The
/// amplitude below 1 allows for pixels of the other side.
inline std::array<float, kSupport> make_step() {
  constexpr double kAmplitude = 0.72, kSlope = 1;
  std::array<float, kSupport> out{};
  for (int i = 0; i < kSupport; ++i) {
    const double x = i - (kSupport - 1) / 2.0;
    out[static_cast<std::size_t>(i)] = static_cast<float>(-kAmplitude * std::tanh(x / 2 / kSlope));
  }
  return out;
}
inline const std::array<float, kSupport> kStep = make_step();

}  // namespace hypotrack::contour
