#include "line_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace hypotrack::contour {
namespace {

/// Returns twice the expected probability less 1, for each segment about a place. The amplitude
/// below 1 allows for pixels of the other side.
std::array<float, kSupport> make_step() {
  constexpr double kAmplitude = 0.72, kSlope = 1;
  std::array<float, kSupport> out{};
  for (int i = 0; i < kSupport; ++i) {
    const double x = i - (kSupport - 1) / 2.0;
    out[static_cast<std::size_t>(i)] = static_cast<float>(-kAmplitude * std::tanh(x / 2 / kSlope));
  }
  return out;
}

const std::array<float, kSupport> kStep = make_step();

}  // namespace

Place find_place(const Segments& likeness) {
  float sum = 0, mean = 0, square = 0;
  for (int place = 0; place < kSteps; ++place) {
    float likelihood = 1;
    for (int i = 0; i < kSupport; ++i)
      likelihood *=
          1 + kStep[static_cast<std::size_t>(i)] * likeness[static_cast<std::size_t>(place + i)];
    const float x = static_cast<float>(place) - (kSteps - 1) / 2.0f;
    sum += likelihood;
    mean += likelihood * x;
    square += likelihood * x * x;
  }
  mean /= sum;
  constexpr float kLeastVariance = 0.25f;  // places are a segment apart
  return {mean, std::max(square / sum - mean * mean, kLeastVariance)};
}

}  // namespace hypotrack::contour
