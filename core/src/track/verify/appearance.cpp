#include "track/verify/appearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hypotrack::internal {
namespace {

constexpr float kNewest = 0.1f;   // least weight of a new colour
constexpr double kNoise = 10;     // of a channel, 0 .. 255: noise and changes of light
constexpr double kEnough = 0.5;   // share of the visible points that were seen before
constexpr int kLeast = 30;        // points
constexpr double kShift = 0.008;  // metres by which a picture may be off
constexpr double kFarthest = 4;   // grid points: the same, of models that are small
constexpr int kSteps = 2;         // to each side

cv::Vec3f color_at(const cv::Mat3f& grid, const cv::Point2f& p) {
  const int x = std::clamp(static_cast<int>(std::floor(p.x)), 0, grid.cols - 2);
  const int y = std::clamp(static_cast<int>(std::floor(p.y)), 0, grid.rows - 2);
  const float fx = std::clamp(p.x - static_cast<float>(x), 0.0f, 1.0f);
  const float fy = std::clamp(p.y - static_cast<float>(y), 0.0f, 1.0f);
  return (1 - fy) * ((1 - fx) * grid(y, x) + fx * grid(y, x + 1)) +
         fy * ((1 - fx) * grid(y + 1, x) + fx * grid(y + 1, x + 1));
}

/// Subtracts the mean from the colours. Returns the sum of their squares plus that of noise of
/// kNoise.
double center(std::vector<cv::Vec3f>& colors) {
  cv::Vec3f mean(0, 0, 0);
  for (const cv::Vec3f& color : colors) mean += color;
  mean *= 1 / static_cast<float>(colors.size());
  float squares = 0;
  for (cv::Vec3f& color : colors) {
    color -= mean;
    squares += color.dot(color);
  }
  return double{squares} + kNoise * kNoise * 3 * static_cast<double>(colors.size());
}

}  // namespace

void Appearance::expect(std::vector<cv::Vec3f> colors) {
  times_.assign(colors.size(), 1);
  colors_ = std::move(colors);
}

void Appearance::learn(const SurfaceSamples& samples) {
  const std::vector<SurfaceSamples::Point>& points = samples.points;
  colors_.resize(points.size());
  times_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].seen) continue;
    ++times_[i];
    colors_[i] += std::max(1 / times_[i], kNewest) *
                  (color_at(samples.views[0].color, points[i].at) - colors_[i]);
  }
}

double Appearance::likeness(const SurfaceSamples& samples) const {
  const std::vector<SurfaceSamples::Point>& points = samples.points;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (points.size() != colors_.size()) return kUnknown;
  int seen = 0;
  std::vector<cv::Point2f> at;
  std::vector<cv::Vec3f> before;
  for (std::size_t i = 0; i < points.size(); ++i) {
    seen += points[i].seen;
    if (!points[i].seen || times_[i] == 0) continue;
    at.push_back(points[i].at);
    before.push_back(colors_[i]);
  }
  const auto known = static_cast<int>(at.size());
  if (known < std::max(kLeast, static_cast<int>(kEnough * seen))) return kUnknown;
  const double step = std::min(kShift * samples.points_per_metre, kFarthest) / kSteps;
  const double of_before = center(before);
  std::vector<cv::Vec3f> now(at.size());
  double best = -1;
  for (int dy = -kSteps; dy <= kSteps; ++dy)
    for (int dx = -kSteps; dx <= kSteps; ++dx) {
      const cv::Point2f shift(static_cast<float>(dx * step), static_cast<float>(dy * step));
      for (std::size_t i = 0; i < at.size(); ++i)
        now[i] = color_at(samples.views[0].color, at[i] + shift);
      const double of_now = center(now);
      float both = 0;
      for (std::size_t i = 0; i < at.size(); ++i) both += now[i].dot(before[i]);
      best = std::max(best, double{both} / std::sqrt(of_now * of_before));
    }
  return best;
}

}  // namespace hypotrack::internal
