#include "line_distribution.hpp"

#include <algorithm>
#include <array>
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

// Pixels from the outline's first place that tell the colour of a side: beyond the mixed ones, and
// not so far that the surface looks different.
constexpr float kFrom = 1.5f, kTo = 6;
constexpr float kLeastContrast = 30;  // of 8-bit colours; several times the noise
constexpr float kDisagreement = 3;    // variance per square of the difference of both places

using Color = Eigen::Array4f;
using Colors = std::array<Color, kSegments>;

/// Returns the colour between four pixels, that of the border beyond it.
Color color_at(const cv::Mat4f& color, const Eigen::Vector2f& at) {
  const float x = std::clamp(at.x(), 0.0f, static_cast<float>(color.cols) - 1.001f);
  const float y = std::clamp(at.y(), 0.0f, static_cast<float>(color.rows) - 1.001f);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const float u = x - static_cast<float>(left), v = y - static_cast<float>(top);
  const auto row = [&](int index) -> Color {
    const float* pixel = color.ptr<float>(index) + std::ptrdiff_t{4} * left;
    return (1 - u) * Eigen::Map<const Color>(pixel) + u * Eigen::Map<const Color>(pixel + 4);
  };
  return (1 - v) * row(top) + v * row(top + 1);
}

/// Mean colour of one side of a line.
struct Side {
  Color sum = Color::Zero();
  int count = 0;
  void add(const Color& color) {
    sum += color;
    ++count;
  }
  Color mean() const { return sum / static_cast<float>(count); }
};

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

Place refine_place(const Place& place, const cv::Mat4f& color, const Eigen::Vector2f& middle,
                   const Eigen::Vector2f& normal) {
  Colors colors;
  Side inside, outside;
  for (int k = 0; k < kSegments; ++k) {
    Color& here = colors[static_cast<std::size_t>(k)];
    here = color_at(color, middle + from_middle(k) * normal);
    const float off = from_middle(k) - place.mean;
    if (off < -kFrom && off > -kTo) inside.add(here);
    if (off > kFrom && off < kTo) outside.add(here);
  }
  if (inside.count == 0 || outside.count == 0) return place;
  const Color beside = outside.mean();
  const Color contrast = inside.mean() - beside;
  const float square = contrast.square().sum();
  if (square < kLeastContrast * kLeastContrast) return place;
  Segments likeness;
  for (std::size_t k = 0; k < colors.size(); ++k)
    likeness[k] = 2 * std::clamp((contrast * (colors[k] - beside)).sum() / square, 0.0f, 1.0f) - 1;
  const float mean = find_place(likeness).mean;
  const float apart = mean - place.mean;
  return {mean, place.variance + kDisagreement * apart * apart};
}

}  // namespace hypotrack::contour
