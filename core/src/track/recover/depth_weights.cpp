#include "track/recover/depth_weights.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kPlanes = 48;      // evenly spaced in inverse depth
constexpr double kBeyond = 8;    // of the farthest depth: where planes end
constexpr double kBefore = 0.8;  // of the nearest depth
constexpr int kWindow = 7;       // pixels of a reduced picture

cv::Mat1f gray_of(const cv::Mat3b& picture) {
  cv::Mat1b gray;
  cv::cvtColor(picture, gray, cv::COLOR_BGR2GRAY);
  return cv::Mat1f(gray);
}

cv::Mat1f box(const cv::Mat1f& values) {
  cv::Mat1f out;
  cv::boxFilter(values, out, CV_32F, {kWindow, kWindow});
  return out;
}

/// Grey values of a picture, their mean and variance over windows.
struct Windows {
  explicit Windows(cv::Mat1f values)
      : gray(std::move(values)), mean(box(gray)), variance(box(gray.mul(gray)) - mean.mul(mean)) {}
  cv::Mat1f gray, mean, variance;
};

/// Returns the correlation of two pictures of the same size over windows.
cv::Mat1f correlation(const Windows& a, const Windows& b) {
  constexpr double kNoise = 3;  // standard deviation of grey values that counts as noise
  const cv::Mat1f covariance = box(a.gray.mul(b.gray)) - a.mean.mul(b.mean);
  cv::Mat1f spread;
  cv::sqrt((a.variance + kNoise * kNoise).mul(b.variance + kNoise * kNoise), spread);
  return covariance / spread;
}

}  // namespace

DepthWeights::DepthWeights(const std::vector<Camera>& cameras, std::array<int, 2> reductions,
                           double nearest, double farthest)
    : cameras_(cameras), reductions_(reductions), nearest_(nearest), farthest_(farthest) {}

void DepthWeights::make_planes(std::size_t view, const cv::Size& size, const StopCheck& stop) {
  if (!planes_[view].empty() && planes_[view].front().other.size() == size) return;
  const Camera &own = cameras_[view], &other = cameras_[1 - view];
  const int by = reductions_[view], by_other = reductions_[1 - view];
  const Eigen::Isometry3d world_from_own = own.camera_from_world.inverse();
  Eigen::Matrix2Xd pixels(2, size.area());
  for (Eigen::Index i = 0; i < pixels.cols(); ++i)
    pixels.col(i) << (static_cast<int>(i) % size.width + 0.5) * by - 0.5,
        (static_cast<int>(i) / size.width + 0.5) * by - 0.5;
  const Eigen::Matrix3Xd rays = back_project(own, pixels);
  const double first = 1 / (kBefore * nearest_), last = 1 / (kBeyond * farthest_);
  std::vector<Plane> planes(kPlanes);
  tbb::parallel_for(0, kPlanes, [&](int k) {
    stop();
    const double depth = 1 / (first + (last - first) * k / (kPlanes - 1));
    Plane plane{depth >= nearest_ && depth <= farthest_, cv::Mat2f(size)};
    for (Eigen::Index i = 0; i < rays.cols(); ++i) {
      const Eigen::Vector3d point = world_from_own * Eigen::Vector3d(depth * rays.col(i));
      const Eigen::Vector2d there = project(other, point);  // NaN behind the camera
      const bool seen = there.allFinite() && there.cwiseAbs().maxCoeff() < 1e5;
      plane.other(static_cast<int>(i) / size.width, static_cast<int>(i) % size.width) =
          seen ? cv::Vec2f(static_cast<float>((there.x() + 0.5) / by_other - 0.5),
                           static_cast<float>((there.y() + 0.5) / by_other - 0.5))
               : cv::Vec2f(-1e4f, -1e4f);
    }
    planes[static_cast<std::size_t>(k)] = std::move(plane);
  });
  planes_[view] = std::move(planes);
}

std::array<cv::Mat1f, 2> DepthWeights::weights(const std::array<cv::Mat3b, 2>& pictures) {
  constexpr double kSharpness = 12;  // of the soft maximum over correlations
  const StopCheck stop;
  std::array<cv::Mat1f, 2> out;
  tbb::parallel_for(std::size_t{0}, std::size_t{2}, [&](std::size_t i) {
    make_planes(i, pictures[i].size(), stop);
    const Windows own(gray_of(pictures[i]));
    const cv::Mat1f other = gray_of(pictures[1 - i]);
    cv::Mat1f in_range = cv::Mat1f::zeros(pictures[i].size()), all = in_range.clone();
    for (const Plane& plane : planes_[i]) {
      stop();
      cv::Mat1f warped, likelihood;
      cv::remap(other, warped, plane.other, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
      cv::exp(kSharpness * correlation(own, Windows(warped)), likelihood);
      all += likelihood;
      if (plane.in_range) in_range += likelihood;
    }
    out[i] = in_range / all;
  });
  return out;
}

}  // namespace hypotrack::internal
