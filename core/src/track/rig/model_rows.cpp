#include "track/rig/model_rows.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "camera/lens_map.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kFewestPoints = 60, kMostPoints = 250;  // points

// Places of the search, in units of x/z and y/z: a hand at 0.5 m is 0.35 long.
constexpr float kShiftStep = 0.005F;
constexpr int kRowSteps = 12, kColumnSteps = 4;  // steps to each side

/// How fast a surface moves across the rows by where the first image shows it.
struct RowSpeeds {
  Eigen::Vector3d factors;  ///< of 1, x and y, in pixels
  double typical = 0;       ///< signed root mean square, per second

  /// Returns a point's speed against the typical one.
  float share(const Eigen::Vector2f& pixel) const {
    if (typical == 0) return 1;
    const Eigen::Vector3d at(1, double{pixel.x()}, double{pixel.y()});
    return static_cast<float>(std::clamp(factors.dot(at) / typical, -3.0, 3.0));
  }
};

/// A point of the first image with what it shows, in the second.
struct SeenPoint {
  float grey;
  float speed;  ///< against the typical one
  PointPair pair;
};

/// Returns the green of an image's nearest pixel, negative outside.
float green_at(const cv::Mat& image, const Eigen::Vector2f& at) {
  const int x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
  if (x < 0 || y < 0 || x >= image.cols || y >= image.rows) return -1;
  return image.ptr<cv::Vec3b>(y)[x][1];
}

/// Returns the correlation of the samples with the second image, moved along the rows, and across
/// them by their speed.
double correlation(const std::vector<SeenPoint>& samples, const cv::Mat& second, float along,
                   float across) {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (const auto& [grey, speed, pair] : samples) {
    const float other =
        green_at(second, pair.other + along * pair.along + across * speed * pair.across);
    if (other < 0) continue;
    const double x = grey, y = other;
    n += 1;
    a += x;
    b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  if (n < kFewestPoints) return 0;
  const double variances = (aa - a * a / n) * (bb - b * b / n);
  return variances > 0 ? (ab - a * b / n) / std::sqrt(variances) : 0;
}

/// Fits the speeds of a model's landmarks. A hand also turns.
RowSpeeds row_speeds(const LensMap& lens, const Eigen::Matrix3Xd& now,
                     const Eigen::Matrix3Xd& before, double seconds) {
  Eigen::MatrixX3d places(now.cols(), 3);
  Eigen::VectorXd speeds(now.cols());
  for (Eigen::Index i = 0; i < now.cols(); ++i) {
    const Eigen::Vector2d ray = now.col(i).hnormalized(), earlier = before.col(i).hnormalized();
    const ImagePoint pixel =
        image_point_along(lens, static_cast<float>(ray.x()), static_cast<float>(ray.y()));
    places.row(i) << 1, double{pixel.x}, double{pixel.y};
    speeds[i] = (ray.y() - earlier.y()) / seconds;
  }
  const Eigen::Vector3d factors = places.completeOrthogonalDecomposition().solve(speeds);
  const Eigen::VectorXd fitted = places * factors;
  const double typical = std::sqrt(fitted.squaredNorm() / static_cast<double>(fitted.size()));
  return {factors, fitted.sum() < 0 ? -typical : typical};
}

/// Returns how far the second image shows the typical point lower, in units of y/z.
std::optional<double> rows_off(const Frame& frame, const std::vector<PointPair>& pairs,
                               const RowSpeeds& speeds) {
  constexpr double kAlike = 0.6;  // correlation
  const std::size_t step = pairs.size() / kMostPoints + 1;
  std::vector<SeenPoint> samples;
  for (std::size_t i = 0; i < pairs.size(); i += step) {
    const float grey = green_at(frame.views[0].color, pairs[i].first);
    if (grey >= 0) samples.push_back({grey, speeds.share(pairs[i].first), pairs[i]});
  }
  if (samples.size() < kFewestPoints) return {};
  std::array<double, 2 * kRowSteps + 1> best{};
  for (int r = 0; r <= 2 * kRowSteps; ++r)
    for (int c = -kColumnSteps; c <= kColumnSteps; ++c) {
      double& most = best[static_cast<std::size_t>(r)];
      most = std::max(most,
                      correlation(samples, frame.views[1].color, kShiftStep * static_cast<float>(c),
                                  kShiftStep * static_cast<float>(r - kRowSteps)));
    }
  const auto peak = std::ranges::max_element(best);
  if (*peak < kAlike || peak == best.begin() || peak == best.end() - 1) return {};
  const double bend = peak[-1] - 2 * peak[0] + peak[1];
  const double part = bend < 0 ? std::clamp(0.5 * (peak[-1] - peak[1]) / bend, -0.5, 0.5) : 0;
  return double{kShiftStep} * (static_cast<double>(peak - best.begin()) - kRowSteps + part);
}

}  // namespace

std::optional<RowMotion> ModelRows::next(const Frame& frame, const TileMaker& tiles,
                                         const Eigen::VectorXd& state) {
  constexpr int kEvery = 3;
  const auto before = std::exchange(before_, Moment{frame.time, state});
  const auto shows = [](const View& view) { return view.color.type() == CV_8UC3; };
  if (++frames_ % kEvery != 0 || !before || !(frame.time > before->time)) return {};
  if (scene_.landmark_names().size() < 3 || !std::ranges::all_of(frame.views, shows)) return {};
  const Observation header = tiles.plan(frame, state).header;
  if (!header.rectified) return {};
  sampler_.draw(header, state);
  const Eigen::Isometry3d& camera_from_world = header.views[0].camera.camera_from_world;
  const RowSpeeds speeds =
      row_speeds(tiles.resamplers()[0].lens(), camera_from_world * scene_.landmarks(state),
                 camera_from_world * scene_.landmarks(before->state), frame.time - before->time);
  const auto rows = rows_off(frame, sampler_.pairs(tiles.resamplers(), 1), speeds);
  return rows ? std::optional(RowMotion{frame.time, speeds.typical, *rows}) : std::nullopt;
}

}  // namespace hypotrack::internal
