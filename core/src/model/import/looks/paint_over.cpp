#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "model/import/looks/patches.hpp"
#include "model/import/srgb.hpp"

namespace hypotrack::internal {
namespace {

/// The light that triangles let through a picture's pixels.
struct Filter {
  explicit Filter(const cv::Size& size) : light(size, cv::Vec3f(1, 1, 1)), is_set(size, 0) {}

  cv::Mat3f light;  // RGB
  cv::Mat1b is_set;
  std::size_t pixels = 0, conflicts = 0;  // of triangles that differ

  void set(int x, int y, const cv::Vec3f& rgb) {
    constexpr double kSame = 0.02;
    ++pixels;
    if (is_set(y, x)) {
      conflicts += cv::norm(light(y, x) - rgb, cv::NORM_INF) > kSame ? 1 : 0;
      return;
    }
    light(y, x) = rgb;
    is_set(y, x) = 1;
  }
};

std::array<cv::Vec3f, 3> corner_colors(const PaintedTriangle& triangle, bool linear) {
  std::array<cv::Vec3f, 3> out;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint8_t byte = triangle.colors[k][c];
      out[k][static_cast<int>(c)] =
          linear ? srgb::light_of_bytes()[byte] : static_cast<float>(byte) / 255;
    }
  }
  return out;
}

/// Sets the filter's pixels whose centres are in a triangle.
void draw(const PaintedTriangle& triangle, bool linear, Filter& filter) {
  const int width = filter.light.cols, height = filter.light.rows;
  const Eigen::Array3f x = triangle.uv.row(0).array() * static_cast<float>(width) - 0.5f;
  const Eigen::Array3f y = (1 - triangle.uv.row(1).array()) * static_cast<float>(height) - 0.5f;
  const float area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (area == 0) return;
  const auto low = [](const Eigen::Array3f& all) {
    return std::max(0, static_cast<int>(std::ceil(all.minCoeff())));
  };
  const auto high = [](const Eigen::Array3f& all, int count) {
    return std::min(count - 1, static_cast<int>(std::floor(all.maxCoeff())));
  };
  const std::array<cv::Vec3f, 3> colors = corner_colors(triangle, linear);
  for (int row = low(y); row <= high(y, height); ++row) {
    for (int column = low(x); column <= high(x, width); ++column) {
      const float dx = static_cast<float>(column) - x[0], dy = static_cast<float>(row) - y[0];
      const float first = (dx * (y[2] - y[0]) - (x[2] - x[0]) * dy) / area;
      const float second = ((x[1] - x[0]) * dy - dx * (y[1] - y[0])) / area;
      if (first < 0 || second < 0 || first + second > 1) continue;
      cv::Vec3f rgb = (1 - first - second) * colors[0] + first * colors[1] + second * colors[2];
      for (int c = 0; !linear && c < 3; ++c) rgb[c] = srgb::linear(rgb[c]);
      filter.set(column, row, rgb);
    }
  }
}

/// Gives the pixels beside the triangles the light of their nearest pixel within: filters of
/// renderers mix both.
void spread(Filter& filter) {
  cv::Mat1f distance;
  cv::Mat1i nearest;
  cv::distanceTransform(filter.is_set == 0, distance, nearest, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  double most = 0;
  cv::minMaxLoc(nearest, nullptr, &most);
  std::vector<cv::Vec3f> light(static_cast<std::size_t>(most) + 1);
  for (int y = 0; y < nearest.rows; ++y)
    for (int x = 0; x < nearest.cols; ++x)
      if (filter.is_set(y, x)) light[static_cast<std::size_t>(nearest(y, x))] = filter.light(y, x);
  for (int y = 0; y < nearest.rows; ++y)
    for (int x = 0; x < nearest.cols; ++x)
      if (!filter.is_set(y, x)) filter.light(y, x) = light[static_cast<std::size_t>(nearest(y, x))];
}

/// Returns the area of the triangles in a picture, in pixels.
double area_of(const std::vector<PaintedTriangle>& triangles, const cv::Size& size) {
  double area = 0;
  for (const PaintedTriangle& triangle : triangles) {
    const Eigen::Vector2f a = triangle.uv.col(1) - triangle.uv.col(0);
    const Eigen::Vector2f b = triangle.uv.col(2) - triangle.uv.col(0);
    area += std::abs(double{a.x()} * double{b.y()} - double{a.y()} * double{b.x()}) / 2;
  }
  return area * size.area();
}

}  // namespace

bool paint_over(const std::vector<PaintedTriangle>& triangles, bool linear, cv::Mat3b& picture) {
  constexpr double kEnough = 8;  // pixels per triangle that show how its colour changes
  if (area_of(triangles, picture.size()) < kEnough * static_cast<double>(triangles.size()))
    return false;
  Filter filter(picture.size());
  for (const PaintedTriangle& triangle : triangles) draw(triangle, linear, filter);
  constexpr std::size_t kFew = 200;  // seams overlap by rounding
  if (filter.pixels == 0 || filter.conflicts > filter.pixels / kFew) return false;
  spread(filter);
  cv::Mat3b painted(picture.size());
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      for (int c = 0; c < 3; ++c)
        painted(y, x)[c] = srgb::byte_of_light(srgb::light_of_bytes()[picture(y, x)[c]] *
                                               filter.light(y, x)[2 - c]);
  picture = painted;
  return true;
}

}  // namespace hypotrack::internal
