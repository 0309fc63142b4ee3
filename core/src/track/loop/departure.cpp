#include "track/loop/departure.hpp"

#include <algorithm>
#include <utility>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the share of points that a camera's picture shows.
double visible_share(const Camera& camera, const Eigen::Matrix3Xd& points) {
  int inside = 0;
  for (const auto& point : points.colwise()) {
    if (!((camera.camera_from_world * Eigen::Vector3d(point)).z() > 0)) continue;
    const Eigen::Vector2d at = project(camera, point);
    inside += at.x() > -0.5 && at.y() > -0.5 && at.x() < camera.width - 0.5 &&
              at.y() < camera.height - 0.5;
  }
  return static_cast<double>(inside) / static_cast<double>(points.cols());
}

}  // namespace

Departure::Departure(const Scene& scene, std::vector<Camera> cameras)
    : scene_(scene), cameras_(std::move(cameras)), seen_(scene.items().size()) {}

void Departure::remember(const Eigen::VectorXd& state, double time,
                         const std::vector<bool>& models) {
  constexpr double kLongest = 0.2;  // seconds between two poses that tell a velocity
  for (std::size_t m = 0; m < seen_.size(); ++m) {
    if (!models[m]) continue;
    const Scene::Item& item = scene_.items()[m];
    Seen& seen = seen_[m];
    Eigen::Matrix3Xd now = posed_landmarks(*item.model, scene_.part(item, state));
    const double seconds = time - seen.time;
    if (seen.landmarks.cols() > 0 && seconds > 0 && seconds < kLongest)
      seen.velocities = (now - seen.landmarks) / seconds;
    else
      seen.velocities = Eigen::Matrix3Xd::Zero(3, now.cols());
    seen.landmarks = std::move(now);
    seen.time = time;
  }
}

bool Departure::is_gone(std::size_t model, double time) const {
  constexpr double kMost = 0.5;   // share of the landmarks that some picture may still show
  constexpr double kAhead = 0.1;  // seconds: models are lost when part of them has left
  constexpr double kLongest = 0.5;
  const Seen& seen = seen_[model];
  if (seen.landmarks.cols() == 0) return false;
  const double seconds = std::min(std::max(time - seen.time, 0.0) + kAhead, kLongest);
  const Eigen::Matrix3Xd there = seen.landmarks + seconds * seen.velocities;
  return std::ranges::all_of(
      cameras_, [&](const Camera& camera) { return visible_share(camera, there) < kMost; });
}

}  // namespace hypotrack::internal
