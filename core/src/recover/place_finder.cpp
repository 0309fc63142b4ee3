#include "recover/place_finder.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace hypotrack {
namespace {

constexpr int kWidth = 240;  // of a reduced picture, about
constexpr int kStep = 3;     // pixels of it between the points of the sweep
constexpr int kDepths = 20;  // planes, evenly spaced in disparity
constexpr std::size_t kMostSorted = 2000;
constexpr double kLeast = 0.2;  // share of the model's colours worth a comparison

/// A view, reduced.
struct Reduced {
  cv::Mat3b color;
  cv::Mat1f gray;
  cv::Mat1f probability;  ///< of foreground
  cv::Mat1d sums;         ///< integral of that

  /// Mean probability over a window; what lies outside the picture counts as 0.
  double mean(float x, float y, float r) const {
    const int side = 2 * std::max(1, static_cast<int>(std::lround(r))) + 1;
    const int left = static_cast<int>(std::lround(x)) - side / 2;
    const int top = static_cast<int>(std::lround(y)) - side / 2;
    const auto column = [&](int at) { return std::clamp(at, 0, color.cols); };
    const auto row = [&](int at) { return std::clamp(at, 0, color.rows); };
    const int x0 = column(left), x1 = column(left + side), y0 = row(top), y1 = row(top + side);
    return (sums(y1, x1) - sums(y0, x1) - sums(y1, x0) + sums(y0, x0)) / (side * side);
  }
};

Reduced reduce(const cv::Mat& picture, int by, const ForegroundColors& colors, const ColorMap& map,
               const cv::Mat1b& taken) {
  Reduced out;
  cv::resize(picture, out.color, {std::max(1, picture.cols / by), std::max(1, picture.rows / by)},
             0, 0, cv::INTER_AREA);
  out.probability.create(out.color.size());
  out.gray.create(out.color.size());
  for (int y = 0; y < out.color.rows; ++y)
    for (int x = 0; x < out.color.cols; ++x) {
      const cv::Vec3b& c = out.color(y, x);
      cv::Vec3f mapped;
      for (int i = 0; i < 3; ++i)
        mapped[i] = map.gain[i] * static_cast<float>(c[i]) + map.offset[i];
      out.probability(y, x) = colors.probability(mapped);
      out.gray(y, x) = (mapped[0] + mapped[1] + mapped[2]) / 3;
    }
  if (!taken.empty()) out.probability.setTo(0, taken);
  cv::integral(out.probability, out.sums, CV_64F);
  return out;
}

/// Mean probability of what is beside a window, up to twice its size.
double ring_mean(const Reduced& view, float x, float y, float r, double inside) {
  return (4 * view.mean(x, y, 2 * r) - inside) / 3;
}

/// Where the foreground's center lies within a window, against the window's.
Eigen::Vector2d offset_of_center(const Reduced& view, double x, double y, double r) {
  double sum = 0;
  Eigen::Vector2d moment(0, 0);
  const int half = std::max(2, static_cast<int>(std::lround(r)));
  const int x0 = static_cast<int>(std::lround(x)), y0 = static_cast<int>(std::lround(y));
  for (int v = std::max(0, y0 - half); v < std::min(view.probability.rows, y0 + half + 1); ++v)
    for (int u = std::max(0, x0 - half); u < std::min(view.probability.cols, x0 + half + 1); ++u) {
      const double p = double{view.probability(v, u)};
      sum += p;
      moment += p * Eigen::Vector2d(u - x, v - y);
    }
  return sum > 0 ? Eigen::Vector2d(moment / sum) : Eigen::Vector2d(0, 0);
}

/// Moves a place to where both views have the foreground's center around it (mean shift: Comaniciu
/// and Meer, "Mean shift: a robust approach toward feature space analysis", PAMI 2002).
Eigen::Vector3d centered(const std::array<Reduced, 2>& views, const std::vector<Camera>& cameras,
                         const int (&reductions)[2], Eigen::Vector3d center, double radius) {
  constexpr int kRounds = 4;
  constexpr double kWider = 1.2;      // than the model's radius
  constexpr double kStepSize = 1e-3;  // metres, of differences
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix<double, 4, 3> jacobian;
    Eigen::Vector4d offsets;
    for (std::size_t i = 0; i < 2; ++i) {
      const Camera& camera = cameras[i];
      const double by = reductions[i], depth = (camera.camera_from_world * center).z();
      const Eigen::Vector2d p = project(camera, center);
      if (!p.allFinite() || !(depth > 0)) return center;
      offsets.segment<2>(2 * static_cast<Eigen::Index>(i)) =
          by * offset_of_center(views[i], (p.x() + 0.5) / by - 0.5, (p.y() + 0.5) / by - 0.5,
                                kWider * camera.fx * radius / depth / by);
      for (int k = 0; k < 3; ++k)
        jacobian.block<2, 1>(2 * static_cast<Eigen::Index>(i), k) =
            (project(camera, center + kStepSize * Eigen::Vector3d::Unit(k)) - p) / kStepSize;
    }
    if (!jacobian.allFinite()) return center;
    center += jacobian.colPivHouseholderQr().solve(offsets);
  }
  return center;
}

/// Correlation of two views' grey values over a patch that faces the first camera.
double correlation(const Reduced& a, float ax, float ay, float ar, const Reduced& b, float bx,
                   float by, float br) {
  constexpr int kHalf = 3;
  constexpr double kNoise = 4;  // standard deviation of grey values that says nothing
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  int n = 0;
  const auto at = [](const Reduced& view, float x, float y, float& value) {
    const int column = static_cast<int>(std::lround(x)), row = static_cast<int>(std::lround(y));
    if (column < 0 || row < 0 || column >= view.gray.cols || row >= view.gray.rows) return false;
    value = view.gray(row, column);
    return true;
  };
  for (int v = -kHalf; v <= kHalf; ++v)
    for (int u = -kHalf; u <= kHalf; ++u) {
      float p = 0, q = 0;
      const float du = static_cast<float>(u) / kHalf, dv = static_cast<float>(v) / kHalf;
      if (!at(a, ax + du * ar, ay + dv * ar, p) || !at(b, bx + du * br, by + dv * br, q)) continue;
      sa += p, sb += q, saa += p * p, sbb += q * q, sab += p * q;
      ++n;
    }
  if (n < kHalf * kHalf) return 0;
  const double va = saa / n - sa * sa / n / n + kNoise * kNoise;
  const double vb = sbb / n - sb * sb / n / n + kNoise * kNoise;
  return (sab / n - sa * sb / n / n) / std::sqrt(va * vb);
}

}  // namespace

PlaceFinder::PlaceFinder(const std::vector<Camera>& cameras, double radius, double nearest,
                         double farthest)
    : cameras_(cameras), radius_(radius) {
  if (cameras.size() < 2) return;
  for (std::size_t i = 0; i < 2; ++i)
    reductions_[i] = std::max(1, static_cast<int>(std::lround(cameras[i].width / double{kWidth})));
  const Camera& first = cameras[0];
  const Eigen::Isometry3d world_from_first = first.camera_from_world.inverse();
  const int step = kStep * reductions_[0];
  for (int plane = 0; plane < kDepths; ++plane) {
    const double share = plane / (kDepths - 1.0);
    const double z = 1 / ((1 - share) / nearest + share / farthest);
    for (int y = step / 2; y < first.height; y += step)
      for (int x = step / 2; x < first.width; x += step) {
        const Eigen::Vector3d center =
            world_from_first *
            Eigen::Vector3d((x - first.cx) / first.fx * z, (y - first.cy) / first.fy * z, z);
        Point point{center.cast<float>(), {}};
        bool inside = true;
        for (std::size_t i = 0; i < 2; ++i) {
          const Camera& camera = cameras[i];
          const Eigen::Vector2d p = project(camera, center);
          inside = inside && p.x() >= 0 && p.y() >= 0 && p.x() < camera.width &&
                   p.y() < camera.height;  // false for NaN
          const double depth = (camera.camera_from_world * center).z();
          const double by = reductions_[i];
          point.windows[i] = {static_cast<float>((p.x() + 0.5) / by - 0.5),
                              static_cast<float>((p.y() + 0.5) / by - 0.5),
                              static_cast<float>(camera.fx * radius / depth / by)};
        }
        if (inside) points_.push_back(point);
      }
  }
}

Places PlaceFinder::find(const Frame& frame, const ForegroundColors& colors, const ColorMap& map,
                         std::size_t count, double apart,
                         const std::array<cv::Mat1b, 2>& taken) const {
  Places out;
  if (frame.views.size() < 2 || frame.views[0].color.empty() || frame.views[1].color.empty() ||
      !colors.known())
    return out;
  const std::array views{reduce(frame.views[0].color, reductions_[0], colors, {}, taken[0]),
                         reduce(frame.views[1].color, reductions_[1], colors, map, taken[1])};
  std::vector<Place> found;
  double seen[2] = {0, 0};
  for (const Point& point : points_) {
    double share[2];
    for (std::size_t i = 0; i < 2; ++i) {
      const Window& w = point.windows[i];
      share[i] = views[i].mean(w.x, w.y, w.r);
      seen[i] = std::max(seen[i], share[i]);
    }
    const double both = std::min(share[0], share[1]);
    if (both < kLeast) continue;
    const Window &a = point.windows[0], &b = point.windows[1];
    const double alike =
        std::max(0.0, correlation(views[0], a.x, a.y, a.r, views[1], b.x, b.y, b.r));
    const double beside = std::max(ring_mean(views[0], a.x, a.y, a.r, share[0]),
                                   ring_mean(views[1], b.x, b.y, b.r, share[1]));
    // Small windows are full of the colours sooner; a forearm has them on both sides, too.
    const double extent = double{a.r} * (both - kLeast - beside);
    if (extent > 0) found.push_back({point.center.cast<double>(), extent * (0.3 + 0.7 * alike)});
  }
  out.seen = std::min(seen[0], seen[1]);
  std::ranges::stable_sort(found, [](const Place& a, const Place& b) { return a.score > b.score; });
  if (found.size() > kMostSorted) found.resize(kMostSorted);
  for (Place& place : found) {
    if (out.best.size() >= count) break;
    const auto is_near = [&](const Place& other) {
      return (place.center - other.center).norm() < apart;
    };
    if (std::ranges::any_of(out.best, is_near)) continue;
    place.center = centered(views, cameras_, reductions_, place.center, radius_);
    const bool near = std::ranges::any_of(
        out.best, [&](const Place& other) { return (place.center - other.center).norm() < apart; });
    if (!near) out.best.push_back(place);
  }
  return out;
}

}  // namespace hypotrack
