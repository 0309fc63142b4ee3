#include "track/rig/model_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace hypotrack::internal {
namespace {

constexpr std::size_t kFewestPoints = 60, kMostPoints = 250;  // points

// Places of the search, in units of x/z and y/z: a hand at 0.5 m is 0.35 long.
constexpr float kShiftStep = 0.005F;
constexpr int kRowSteps = 16, kColumnSteps = 2;  // steps to each side

/// A point of the first image with what it shows, in the second.
struct SeenPoint {
  float grey;
  PointPair pair;
};

/// Returns the green of an image's nearest pixel, negative outside.
float green_at(const cv::Mat& image, const Eigen::Vector2f& at) {
  const int x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
  if (x < 0 || y < 0 || x >= image.cols || y >= image.rows) return -1;
  return image.ptr<cv::Vec3b>(y)[x][1];
}

/// Returns the correlation of the samples with the second image, moved along and across the rows.
double correlation(const std::vector<SeenPoint>& samples, const cv::Mat& second, float along,
                   float across) {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (const auto& [grey, pair] : samples) {
    const float other = green_at(second, pair.other + along * pair.along + across * pair.across);
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

/// Returns the mean height y/z of the scene's landmarks in a camera.
double mean_height(const Scene& scene, const TileCamera& camera, const Eigen::VectorXd& state) {
  const Eigen::Matrix3Xd points = camera.camera_from_world * scene.landmarks(state);
  return (points.row(1).array() / points.row(2).array()).mean();
}

}  // namespace

std::optional<RowMotion> ModelRows::next(const Frame& frame, const TileMaker& tiles,
                                         const Eigen::VectorXd& state) {
  const auto before = std::exchange(before_, Moment{frame.time, state});
  const auto shows = [](const View& view) { return view.color.type() == CV_8UC3; };
  if (!std::ranges::all_of(frame.views, shows)) return {};
  if (++frames_ % 2 != 0 || !before || !(frame.time > before->time)) return {};
  const Observation header = tiles.plan(frame, state).header;
  const auto rows = header.rectified ? rows_in(frame, tiles, header, state) : std::nullopt;
  if (!rows) return {};
  const TileCamera& camera = header.views[0].camera;
  const double moved =
      mean_height(scene_, camera, state) - mean_height(scene_, camera, before->state);
  return RowMotion{frame.time, moved / (frame.time - before->time), *rows};
}

std::optional<double> ModelRows::rows_in(const Frame& frame, const TileMaker& tiles,
                                         const Observation& header, const Eigen::VectorXd& state) {
  constexpr double kAlike = 0.6;  // correlation
  sampler_.draw(header, state);
  const std::vector<PointPair> pairs = sampler_.pairs(tiles.resamplers(), 1);
  const std::size_t step = pairs.size() / kMostPoints + 1;
  std::vector<SeenPoint> samples;
  for (std::size_t i = 0; i < pairs.size(); i += step) {
    const float grey = green_at(frame.views[0].color, pairs[i].first);
    if (grey >= 0) samples.push_back({grey, pairs[i]});
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

}  // namespace hypotrack::internal
