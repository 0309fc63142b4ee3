#include "track/recover/place_finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <utility>

#include "hypotrack/api/stop.hpp"

namespace hypotrack::internal {
/// A reduced view.
struct ReducedView {
  cv::Mat3b color;
  cv::Mat1f gray;
  cv::Mat1f probability;  ///< of foreground
  cv::Mat1d sums;         ///< integral image of `probability`

  /// Returns the mean probability over a window. Pixels outside the picture count as 0.
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

namespace {

constexpr int kWidth = 240;           // approximate width of a reduced picture
constexpr int kStep = 3;              // pixels of it between the points of the sweep
constexpr int kDepths = 20;           // planes, evenly spaced in disparity
constexpr double kLeast = 0.2;        // share of the model's colours worth a comparison
constexpr double kUnexplained = 0.4;  // least share of a place's foreground that other places leave
                                      // unexplained

/// Adds bytes to sums.
void add(const std::uint8_t* bytes, std::span<std::uint16_t> sums) {
  const auto size = static_cast<int>(sums.size());
  int i = 0;
  for (; i + 8 <= size; i += 8)
    cv::v_store(sums.data() + i, cv::v_load(sums.data() + i) + cv::v_load_expand(bytes + i));
  for (; i < size; ++i) sums[static_cast<std::size_t>(i)] += bytes[i];
}

/// Returns the means of squares of `side` pixels. cv::resize() takes many times as long, for only
/// halving is fast there.
cv::Mat3b means_of_squares(const cv::Mat3b& picture, int side) {
  cv::Mat3b out(picture.rows / side, picture.cols / side);
  const cv::v_float32x4 share = cv::v_setall_f32(1 / static_cast<float>(side * side));
  std::vector<std::uint16_t> sums(3 * static_cast<std::size_t>(out.cols * side) + 1);
  for (int y = 0; y < out.rows; ++y) {
    std::ranges::fill(sums, std::uint16_t{0});
    for (int row = y * side; row < (y + 1) * side; ++row)
      add(picture.ptr<std::uint8_t>(row), {sums.data(), sums.size() - 1});
    const std::uint16_t* next = sums.data();
    for (int x = 0; x < out.cols; ++x) {
      cv::v_uint16x8 sum = cv::v_setzero_u16();  // B, G, R and what is beside
      for (int i = 0; i < side; ++i, next += 3) sum += cv::v_load_low(next);
      const auto of_square = cv::v_cvt_f32(cv::v_reinterpret_as_s32(cv::v_expand_low(sum)));
      int mean[4];
      cv::v_store(mean, cv::v_round(share * of_square));
      for (int i = 0; i < 3; ++i) out(y, x)[i] = static_cast<std::uint8_t>(mean[i]);
    }
  }
  return out;
}

ReducedView reduce(cv::Mat3b picture, const ForegroundColors& colors, const ColorMap& map,
                   const cv::Mat1f& weights) {
  ReducedView out;
  out.color = std::move(picture);
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
  if (!weights.empty()) cv::multiply(out.probability, weights, out.probability);
  cv::integral(out.probability, out.sums, CV_64F);
  return out;
}

/// Returns the mean probability around a window, up to twice its size.
double ring_mean(const ReducedView& view, float x, float y, float r, double inside) {
  return (4 * view.mean(x, y, 2 * r) - inside) / 3;
}

/// Computes the correlation of two views' grey values over a patch that faces the first camera.
double correlation(const ReducedView& a, float ax, float ay, float ar, const ReducedView& b,
                   float bx, float by, float br) {
  constexpr int kHalf = 3;
  constexpr double kNoise = 4;  // standard deviation of grey values that counts as noise
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  int n = 0;
  const auto at = [](const ReducedView& view, float x, float y, float& value) {
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

/// A window of a reduced picture: pixel and radius.
struct Patch {
  double x = 0, y = 0, r = 0;
};

/// Projects a ball into a camera's reduced picture. Returns false where the camera cannot see it.
bool patch_of(const Camera& camera, int by, const Eigen::Vector3d& center, double radius,
              Patch& out) {
  const double depth = (camera.camera_from_world * center).z();
  const Eigen::Vector2d p = project(camera, center);
  if (!p.allFinite() || !(depth > 0) || p.cwiseAbs().maxCoeff() > 1e5) return false;
  out = {(p.x() + 0.5) / by - 0.5, (p.y() + 0.5) / by - 0.5, camera.fx * radius / depth / by};
  return true;
}

/// Computes the correlation of two views' grey values over patches, each point weighted by its
/// foreground probability.
double foreground_correlation(const ReducedView& a, const Patch& at, const ReducedView& b,
                              const Patch& there) {
  constexpr int kHalf = 10;
  constexpr double kNoise = 2;  // standard deviation of grey values that counts as noise
  const auto value = [](const cv::Mat1f& picture, double x, double y, double& out) {
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    if (x0 < 0 || y0 < 0 || x0 + 1 >= picture.cols || y0 + 1 >= picture.rows) return false;
    const double fx = x - x0, fy = y - y0;
    out = (1 - fy) * ((1 - fx) * double{picture(y0, x0)} + fx * double{picture(y0, x0 + 1)}) +
          fy * ((1 - fx) * double{picture(y0 + 1, x0)} + fx * double{picture(y0 + 1, x0 + 1)});
    return true;
  };
  double sum = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (int v = -kHalf; v <= kHalf; ++v)
    for (int u = -kHalf; u <= kHalf; ++u) {
      const double du = u / double{kHalf}, dv = v / double{kHalf};
      double p = 0, q = 0, w = 0;
      const double x = at.x + du * at.r, y = at.y + dv * at.r;
      if (!value(a.gray, x, y, p) || !value(a.probability, x, y, w) ||
          !value(b.gray, there.x + du * there.r, there.y + dv * there.r, q))
        continue;
      sum += w, sa += w * p, sb += w * q, saa += w * p * p, sbb += w * q * q, sab += w * p * q;
    }
  if (!(sum > kHalf * kHalf * 0.2)) return 0;
  const double va = saa / sum - sa * sa / sum / sum + kNoise * kNoise;
  const double vb = sbb / sum - sb * sb / sum / sum + kNoise * kNoise;
  return (sab / sum - sa * sb / sum / sum) / std::sqrt(va * vb);
}

}  // namespace

PlaceFinder::PlaceFinder(const std::vector<Camera>& cameras, double radius, double nearest,
                         double farthest)
    : cameras_(cameras), radius_(radius), least_inverse_(1 / farthest), most_inverse_(1 / nearest) {
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

cv::Mat3b PlaceFinder::reduced(const cv::Mat& picture, std::size_t view) const {
  constexpr int kMost = 16;  // pixels along a square: sums of 16 bits hold them
  const int by = reductions_[view];
  if (by <= std::min({picture.cols, picture.rows, kMost})) return means_of_squares(picture, by);
  cv::Mat3b out;
  cv::resize(picture, out, {std::max(1, picture.cols / by), std::max(1, picture.rows / by)}, 0, 0,
             cv::INTER_AREA);
  return out;
}

std::vector<PlaceFinder::Candidate> PlaceFinder::sweep(const Views& views, double& seen) const {
  std::vector<Candidate> found;
  double most[2] = {0, 0};
  for (const Point& point : points_) {
    check_stop();
    double share[2];
    for (std::size_t i = 0; i < 2; ++i) {
      const Window& w = point.windows[i];
      share[i] = views[i].mean(w.x, w.y, w.r);
      most[i] = std::max(most[i], share[i]);
    }
    const double both = std::min(share[0], share[1]);
    if (both < kLeast) continue;
    const Window &a = point.windows[0], &b = point.windows[1];
    const double alike =
        std::max(0.0, correlation(views[0], a.x, a.y, a.r, views[1], b.x, b.y, b.r));
    const double beside = std::max(ring_mean(views[0], a.x, a.y, a.r, share[0]),
                                   ring_mean(views[1], b.x, b.y, b.r, share[1]));
    // Weigh by size, as small windows fill up sooner; subtract the ring, which longer things
    // fill, too.
    const double extent = double{a.r} * (both - kLeast - beside);
    if (extent > 0) found.push_back({&point, both, extent * (0.3 + 0.7 * alike)});
  }
  seen = std::min(most[0], most[1]);
  return found;
}

Places PlaceFinder::find(const Frame& frame, const ForegroundColors& colors, const ColorMap& map,
                         std::size_t count, const std::array<cv::Mat1f, 2>& weights) const {
  Places out;
  if (frame.views.size() < 2 || frame.views[0].color.empty() || frame.views[1].color.empty())
    return out;
  Views views{reduce(reduced(frame.views[0].color, 0), colors, {}, weights[0]),
              reduce(reduced(frame.views[1].color, 1), colors, map, weights[1])};
  const std::vector<Candidate> found = sweep(views, out.seen);
  while (out.best.size() < count) {
    // Count foreground once only, so that several places cover a long object.
    Place best;
    for (const Candidate& one : found) {
      const Window &a = one.point->windows[0], &b = one.point->windows[1];
      const double left =
          std::min(views[0].mean(a.x, a.y, a.r), views[1].mean(b.x, b.y, b.r)) / one.share;
      if (left > kUnexplained && one.score * left > best.score)
        best = {one.point->center.cast<double>(), one.score * left};
    }
    if (best.score == 0) break;
    best.center = at_best_depth(views, best.center);
    out.best.push_back(best);
    for (std::size_t i = 0; i < 2; ++i) explain(views[i], i, best.center);
  }
  return out;
}

Eigen::Vector3d PlaceFinder::at_best_depth(const Views& views,
                                           const Eigen::Vector3d& center) const {
  constexpr int kEachWay = 12;
  const Camera& first = cameras_[0];
  const Eigen::Vector3d ray = first.camera_from_world * center;
  const double step = (most_inverse_ - least_inverse_) / (kDepths - 1.0) / 6;
  Eigen::Vector3d best = center;
  double most = 0;
  for (int k = -kEachWay; k <= kEachWay; ++k) {
    const double inverse = 1 / ray.z() + k * step;
    if (!(inverse >= least_inverse_ && inverse <= most_inverse_)) continue;
    const Eigen::Vector3d there =
        first.camera_from_world.inverse() * Eigen::Vector3d(ray / (ray.z() * inverse));
    Patch a, b;
    if (!patch_of(first, reductions_[0], there, radius_, a) ||
        !patch_of(cameras_[1], reductions_[1], there, radius_, b))
      continue;
    const double alike = foreground_correlation(views[0], a, views[1], b);
    if (alike > most) most = alike, best = there;
  }
  return best;
}

void PlaceFinder::explain(ReducedView& view, std::size_t i, const Eigen::Vector3d& center) const {
  Patch at;
  if (!patch_of(cameras_[i], reductions_[i], center, radius_, at) || !(at.r < view.color.cols))
    return;
  cv::circle(view.probability, {cvRound(at.x), cvRound(at.y)}, std::max(1, cvRound(at.r)), 0,
             cv::FILLED);
  cv::integral(view.probability, view.sums, CV_64F);
}

}  // namespace hypotrack::internal
