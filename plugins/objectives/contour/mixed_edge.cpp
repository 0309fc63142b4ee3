#include "mixed_edge.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace hypotrack::contour {
namespace {

// Pixels from the outline's first place that tell the colour of a side: beyond the mixed ones, and
// not so far that the surface looks different.
constexpr float kFrom = 1.5f, kTo = 6;
constexpr float kLeastContrast = 30;  // of 8-bit colours; several times the noise
constexpr float kDisagreement = 3;    // variance per square of the difference of both places

using Colors = std::array<Eigen::Vector3f, kSegments>;

Eigen::Vector3f color_at(const cv::Mat3b& color, const Eigen::Vector2f& at) {
  const float x = std::clamp(at.x(), 0.0f, static_cast<float>(color.cols) - 1.001f);
  const float y = std::clamp(at.y(), 0.0f, static_cast<float>(color.rows) - 1.001f);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const float u = x - static_cast<float>(left), v = y - static_cast<float>(top);
  const auto pixel = [&](int row, int column) {
    const cv::Vec3b& p = color(row, column);
    return Eigen::Vector3f(p[0], p[1], p[2]);
  };
  return (1 - v) * ((1 - u) * pixel(top, left) + u * pixel(top, left + 1)) +
         v * ((1 - u) * pixel(top + 1, left) + u * pixel(top + 1, left + 1));
}

/// Mean colour of one side of a line.
struct Side {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int count = 0;
  void add(const Eigen::Vector3f& color) {
    sum += color;
    ++count;
  }
  Eigen::Vector3f mean() const { return sum / static_cast<float>(count); }
};

}  // namespace

Place refine_place(const Place& place, const cv::Mat3b& color, const Eigen::Vector2f& middle,
                   const Eigen::Vector2f& normal) {
  Colors colors;
  Side inside, outside;
  for (int k = 0; k < kSegments; ++k) {
    Eigen::Vector3f& here = colors[static_cast<std::size_t>(k)];
    here = color_at(color, middle + from_middle(k) * normal);
    const float off = from_middle(k) - place.mean;
    if (off < -kFrom && off > -kTo) inside.add(here);
    if (off > kFrom && off < kTo) outside.add(here);
  }
  if (inside.count == 0 || outside.count == 0) return place;
  const Eigen::Vector3f beside = outside.mean();
  const Eigen::Vector3f contrast = inside.mean() - beside;
  const float square = contrast.squaredNorm();
  if (square < kLeastContrast * kLeastContrast) return place;
  Segments likeness;
  for (std::size_t k = 0; k < colors.size(); ++k)
    likeness[k] = 2 * std::clamp(contrast.dot(colors[k] - beside) / square, 0.0f, 1.0f) - 1;
  const float mean = find_place(likeness).mean;
  const float apart = mean - place.mean;
  return {mean, place.variance + kDisagreement * apart * apart};
}

}  // namespace hypotrack::contour
