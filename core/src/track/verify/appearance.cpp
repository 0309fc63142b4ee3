#include "track/verify/appearance.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace hypotrack::internal {
namespace {

constexpr float kNewest = 0.1f;   // least weight of a new colour
constexpr float kNoise = 10;      // of a channel, 0 .. 255: noise and changes of light
constexpr float kEnough = 0.5f;   // share of the visible points that were seen before
constexpr int kLeast = 30;        // points
constexpr double kShift = 0.008;  // metres by which a picture may be off
constexpr double kFarthest = 4;   // grid points: the same, of models that are small
constexpr int kSteps = 2;         // to each side

/// Returns B, G, R and 0: one instruction takes four channels.
Eigen::Array4f wide(const cv::Vec3f& color) { return {color[0], color[1], color[2], 0}; }

/// Colours on a grid, row by row.
class ColorGrid {
 public:
  explicit ColorGrid(const cv::Mat3f& grid) : width_(grid.cols), height_(grid.rows) {
    colors_.reserve(grid.total());
    for (const cv::Vec3f& color : grid) colors_.push_back(wide(color));
  }
  /// Interpolates the colour at a point. A point outside gets the colour of the border.
  Eigen::Array4f at(const cv::Point2f& p) const {
    const int x = std::clamp(cvFloor(p.x), 0, width_ - 2);
    const int y = std::clamp(cvFloor(p.y), 0, height_ - 2);
    const float fx = std::clamp(p.x - static_cast<float>(x), 0.0f, 1.0f);
    const float fy = std::clamp(p.y - static_cast<float>(y), 0.0f, 1.0f);
    const Eigen::Array4f* above = colors_.data() + y * width_ + x;
    const Eigen::Array4f* below = above + width_;
    const Eigen::Array4f top = above[0] + fx * (above[1] - above[0]);
    const Eigen::Array4f bottom = below[0] + fx * (below[1] - below[0]);
    return top + fy * (bottom - top);
  }

 private:
  int width_, height_;
  std::vector<Eigen::Array4f> colors_;
};

}  // namespace

void Appearance::expect(const std::vector<cv::Vec3f>& colors) {
  times_.assign(colors.size(), 1);
  colors_.clear();
  std::ranges::transform(colors, std::back_inserter(colors_), wide);
}

void Appearance::learn(const SurfaceSamples& samples) {
  const std::vector<SurfaceSamples::Point>& points = samples.points;
  colors_.resize(points.size(), Eigen::Array4f::Zero());
  times_.resize(points.size());
  const ColorGrid grid(samples.views[0].color);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].seen) continue;
    ++times_[i];
    colors_[i] += std::max(1 / times_[i], kNewest) * (grid.at(points[i].at) - colors_[i]);
  }
}

double Appearance::likeness(const SurfaceSamples& samples) const {
  const std::vector<SurfaceSamples::Point>& points = samples.points;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (points.size() != colors_.size()) return kUnknown;
  int seen = 0;
  std::vector<cv::Point2f> at;
  std::vector<Eigen::Array4f> before;
  Eigen::Array4f mean = Eigen::Array4f::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    seen += points[i].seen;
    if (!points[i].seen || times_[i] == 0) continue;
    at.push_back(points[i].at);
    before.push_back(colors_[i]);
    mean += colors_[i];
  }
  const auto known = static_cast<float>(at.size());
  if (known < std::max<float>(kLeast, kEnough * static_cast<float>(seen))) return kUnknown;
  const float noise = kNoise * kNoise * 3 * known;
  Eigen::Array4f of_before = Eigen::Array4f::Zero();
  for (Eigen::Array4f& color : before) {
    color -= mean / known;
    of_before += color.square();
  }
  const double step = std::min(kShift * samples.points_per_metre, kFarthest) / kSteps;
  const ColorGrid grid(samples.views[0].color);
  float best = -1;
  for (int dy = -kSteps; dy <= kSteps; ++dy)
    for (int dx = -kSteps; dx <= kSteps; ++dx) {
      const cv::Point2f shift(static_cast<float>(dx * step), static_cast<float>(dy * step));
      // `before` has no mean any more, so the products need none of the present colours.
      Eigen::Array4f sum = Eigen::Array4f::Zero(), squares = sum, products = sum;
      for (std::size_t i = 0; i < at.size(); ++i) {
        const Eigen::Array4f now = grid.at(at[i] + shift);
        sum += now;
        squares += now.square();
        products += now * before[i];
      }
      const float of_now = std::max(0.0f, (squares - sum.square() / known).sum());
      best =
          std::max(best, products.sum() / std::sqrt((of_now + noise) * (of_before.sum() + noise)));
    }
  return double{best};
}

}  // namespace hypotrack::internal
