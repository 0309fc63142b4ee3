#include "depth_term.hpp"

#include <cmath>

#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/model.hpp"
#include "pose_slopes.hpp"

namespace hypotrack::contour {
namespace {

constexpr double kFacing = 0.2;  // least cosine between a normal and the way to the camera

std::span<const double> pose_in(const DepthSet& set, std::span<const double> state) {
  return state.subspan(static_cast<std::size_t>(set.offset), kPoseSize);
}

}  // namespace

double beyond(const DepthMatch& match, const Eigen::Isometry3d& world_from_model) {
  const Eigen::Vector3d normal = world_from_model.linear() * match.model.normal.cast<double>();
  return normal.dot(match.measured - world_from_model * match.model.position.cast<double>());
}

std::vector<DepthMatch> match_depth(std::span<const SurfacePoint> points,
                                    const Eigen::Isometry3d& world_from_model,
                                    const TileView& view) {
  const TileCamera& camera = view.camera;
  const Eigen::Isometry3d camera_from_model = camera.camera_from_world * world_from_model;
  const Eigen::Isometry3d world_from_camera = camera.camera_from_world.inverse();
  const cv::Mat1f depth = view.depth;
  std::vector<DepthMatch> out;
  for (const SurfacePoint& point : points) {
    const Eigen::Vector3d at = camera_from_model * point.position.cast<double>();
    const Eigen::Vector3d normal = camera_from_model.linear() * point.normal.cast<double>();
    if (!(at.z() > 0) || !(-normal.dot(at) > kFacing * at.norm())) continue;
    const double u = camera.fx * at.x() / at.z() + camera.cx;
    const double v = camera.fy * at.y() / at.z() + camera.cy;
    if (!(u > 0 && v > 0 && u < depth.cols - 1 && v < depth.rows - 1)) continue;
    const int x = static_cast<int>(u + 0.5), y = static_cast<int>(v + 0.5);
    const double z = double{depth(y, x)};
    if (!(z > 0)) continue;
    const Eigen::Vector3d seen(z * (x - camera.cx) / camera.fx, z * (y - camera.cy) / camera.fy, z);
    const DepthMatch match{point, world_from_camera * seen};
    if (std::abs(beyond(match, world_from_model)) < kDepthReach) out.push_back(match);
  }
  return out;
}

std::int64_t residual_count(std::span<const DepthSet> sets) {
  std::int64_t count = 0;
  for (const DepthSet& set : sets) count += std::ssize(set.matches);
  return count;
}

double cost_and_residuals(std::span<const DepthSet> sets, std::span<const double> state,
                          std::span<float> residuals) {
  double cost = 0;
  std::size_t i = 0;
  for (const DepthSet& set : sets) {
    const Eigen::Isometry3d pose = world_from_model(pose_in(set, state));
    for (const DepthMatch& match : set.matches) {
      const double d = beyond(match, pose);
      const double r = std::sqrt(set.weight) * d / set.sigma / std::hypot(1, d / kDepthReach);
      cost += r * r;
      if (!residuals.empty()) residuals[i++] = static_cast<float>(r);
    }
  }
  return cost;
}

void write_jacobian(std::span<const DepthSet> sets, std::span<const double> state,
                    Eigen::Index first, Jacobian& jacobian) {
  for (const DepthSet& set : sets) {
    const std::span<const double> pose = pose_in(set, state);
    const Eigen::Isometry3d model = world_from_model(pose);
    for (const DepthMatch& match : set.matches) {
      const double bend = std::hypot(1, beyond(match, model) / kDepthReach);
      const double scale = std::sqrt(set.weight) / set.sigma / (bend * bend * bend);
      const Eigen::Vector3d normal = match.model.normal.cast<double>();
      auto row = jacobian.row(first++).segment<kPoseSize>(set.offset);
      row.head<3>() = (-scale * (model.linear() * normal)).transpose().cast<float>();
      const Eigen::Vector3d arm = match.measured - model.translation();
      row.tail<4>() =
          (scale * arm.transpose() * quaternion_slopes(pose.subspan<3, 4>(), normal)).cast<float>();
    }
  }
}

}  // namespace hypotrack::contour
