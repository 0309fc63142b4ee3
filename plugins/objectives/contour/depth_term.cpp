#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/model.hpp"
#include "terms.hpp"

namespace hypotrack::contour {
namespace {

/// Returns number i of a sequence that fills the unit interval evenly (Weyl, with a step that is
/// irrational).
double even(int i, double step) { return std::fmod(0.5 + i * step, 1.0); }

/// Returns six times the volume within a mesh; negative if its triangles face inwards. Openings are
/// closed from the middle.
double volume(const Mesh& mesh) {
  const Eigen::Vector3f middle = mesh.vertices.rowwise().mean();
  double sum = 0;
  for (const Eigen::Vector3i corner : mesh.triangles.colwise()) {
    const Eigen::Vector3f a = mesh.vertices.col(corner[0]) - middle;
    const Eigen::Vector3f b = mesh.vertices.col(corner[1]) - middle;
    sum += double{a.dot(b.cross(mesh.vertices.col(corner[2]) - middle))};
  }
  return sum;
}

constexpr double kFacing = 0.2;  // least cosine between a normal and the way to the camera

std::span<const double> pose_in(const DepthSet& set, std::span<const double> state) {
  return state.subspan(static_cast<std::size_t>(set.offset), kPoseSize);
}

}  // namespace

std::vector<SurfacePoint> spread_points(const Mesh& mesh, int count) {
  std::vector<double> areas;  // up to each triangle's end
  double sum = 0;
  std::vector<Eigen::Vector3f> normals;
  for (const Eigen::Vector3i corner : mesh.triangles.colwise()) {
    const Eigen::Vector3f a = mesh.vertices.col(corner[0]);
    const Eigen::Vector3f normal =
        (mesh.vertices.col(corner[1]) - a).cross(mesh.vertices.col(corner[2]) - a);
    sum += double{normal.norm()};
    areas.push_back(sum);
    normals.push_back(normal.normalized());
  }
  std::vector<SurfacePoint> out;
  if (!(sum > 0)) return out;
  if (volume(mesh) < 0)
    for (Eigen::Vector3f& normal : normals) normal = -normal;
  for (int i = 0; i < count; ++i) {
    const double at = (i + 0.5) / count * sum;
    const auto t = static_cast<Eigen::Index>(std::ranges::lower_bound(areas, at) - areas.begin());
    const Eigen::Vector3i corner = mesh.triangles.col(std::min(t, mesh.triangles.cols() - 1));
    // Of the unit square, the half beyond the diagonal is folded back.
    auto u = static_cast<float>(even(i, 0.7548776662)),
         v = static_cast<float>(even(i, 0.5698402910));
    if (u + v > 1) u = 1 - u, v = 1 - v;
    out.push_back({(1 - u - v) * mesh.vertices.col(corner[0]) + u * mesh.vertices.col(corner[1]) +
                       v * mesh.vertices.col(corner[2]),
                   normals[static_cast<std::size_t>(std::min(t, mesh.triangles.cols() - 1))]});
  }
  return out;
}

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
