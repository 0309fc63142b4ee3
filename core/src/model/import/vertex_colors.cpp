#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

using Color = std::array<std::uint8_t, 3>;  // RGB

cv::Vec3b texel(const std::array<int, 3>& rgb) {
  cv::Vec3b bgr;
  for (int c = 0; c < 3; ++c)
    bgr[2 - c] = static_cast<std::uint8_t>(std::clamp(rgb[static_cast<std::size_t>(c)], 0, 255));
  return bgr;
}

/// Four texels per triangle, between whose centres a bilinear lookup is the linear interpolation of
/// three corners: 0 and 1 above, 2 and 1 + 2 - 0 below. That one is clamped where corners differ
/// much.
void draw_block(const std::array<Color, 3>& corners, cv::Mat block) {
  std::array<int, 3> fourth{};
  for (std::size_t c = 0; c < 3; ++c) {
    fourth[c] = corners[1][c] + corners[2][c] - corners[0][c];
  }
  const auto of = [](const Color& color) { return texel({color[0], color[1], color[2]}); };
  block.at<cv::Vec3b>(0, 0) = of(corners[0]);
  block.at<cv::Vec3b>(0, 1) = of(corners[1]);
  block.at<cv::Vec3b>(1, 0) = of(corners[2]);
  block.at<cv::Vec3b>(1, 1) = texel(fourth);
}

}  // namespace

void fill_vertex_colors(const Soup& soup, const std::vector<int>& kept, Mesh& mesh) {
  const auto color_of = [&](int triangle, int corner) {
    return soup.colors[static_cast<std::size_t>(soup.triangles(corner, triangle))];
  };
  const Color first = color_of(kept.front(), 0);
  const bool uniform = std::ranges::all_of(kept, [&](int t) {
    return color_of(t, 0) == first && color_of(t, 1) == first && color_of(t, 2) == first;
  });
  mesh.color = Eigen::Vector3f(first[0], first[1], first[2]) / 255.0f;
  if (uniform) return;

  const int count = static_cast<int>(kept.size());
  const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
  const int rows = (count + columns - 1) / columns;
  mesh.texture = cv::Mat(2 * rows, 2 * columns, CV_8UC3, cv::Scalar::all(0));
  mesh.uv.resize(2, 3 * Eigen::Index{count});
  mesh.uv_triangles.resize(3, count);
  const auto center = [&](int x, int y) {
    return Eigen::Vector2f((static_cast<float>(x) + 0.5f) / static_cast<float>(2 * columns),
                           1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(2 * rows));
  };
  for (int t = 0; t < count; ++t) {
    const int x = 2 * (t % columns), y = 2 * (t / columns);
    const int triangle = kept[static_cast<std::size_t>(t)];
    draw_block({color_of(triangle, 0), color_of(triangle, 1), color_of(triangle, 2)},
               mesh.texture(cv::Rect(x, y, 2, 2)));
    mesh.uv.col(3 * t) = center(x, y);
    mesh.uv.col(3 * t + 1) = center(x + 1, y);
    mesh.uv.col(3 * t + 2) = center(x, y + 1);
    mesh.uv_triangles.col(t) << 3 * t, 3 * t + 1, 3 * t + 2;
  }
}

}  // namespace hypotrack::internal
