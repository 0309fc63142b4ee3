#include "picture/surface.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace hypotrack::internal {
namespace {

/// Returns the slope of inverse depth at the middle one of three pixels in a row; 0 where neither
/// neighbour (0: none) goes on from it.
float slope(float before, float here, float after) {
  constexpr float kJump = 0.006F;  // metres from pixel to pixel: another part of the surface
  const float most = kJump * here * here;
  const bool from = std::abs(here - before) < most, to = std::abs(after - here) < most;
  if (from && to) return (after - before) / 2;
  return from ? here - before : to ? after - here : 0;
}

}  // namespace

Surface::Surface(const cv::Size& size)
    : inverse_depth(cv::Mat1f::zeros(size)), label(cv::Mat1b::zeros(size)) {}

void Surface::find_slopes(double facet) {
  constexpr int kWidest = 13;
  slopes_ = cv::Mat3f::zeros(label.size());
  for (int y = 1; y + 1 < label.rows; ++y) {
    const float* w = inverse_depth[y];
    for (int x = 1; x + 1 < label.cols; ++x)
      if (w[x] > 0)
        slopes_(y, x) = {slope(w[x - 1], w[x], w[x + 1]),
                         slope(inverse_depth(y - 1, x), w[x], inverse_depth(y + 1, x)), 1};
  }
  const int width = std::min(kWidest, 1 + 2 * static_cast<int>(std::lround(facet / 2)));
  cv::blur(slopes_, slopes_, {width, width});  // the facets of the mesh are not seen
}

Eigen::Vector2f Surface::slopes_at(cv::Point pixel) const {
  const cv::Vec3f& sum = slopes_(pixel);
  if (!(sum[2] > 0)) return Eigen::Vector2f::Zero();
  return {sum[0] / sum[2], sum[1] / sum[2]};
}

}  // namespace hypotrack::internal
