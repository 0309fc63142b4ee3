#include "region_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "hypotrack/plugin/params.hpp"
#include "terms.hpp"

namespace hypotrack::contour {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Prior of one step. A step may be much larger where hundreds of lines agree.
constexpr double kTurn = 2 * kDegree;
constexpr double kMove = 6 * kMillimetre;
constexpr int kFineSteps = 3;  // with segments of one pixel
constexpr std::size_t kLeastRows = 12;

/// Returns the segments' lengths in pixels, from coarse to fine. The lines of the first reach as
/// far as a third of the extent of the model.
std::vector<int> scales(float extent) {
  std::vector<int> out;
  for (int scale = std::max(static_cast<int>(extent) / 32, 1); scale > 1; scale /= 2)
    out.push_back(scale);
  out.insert(out.end(), kFineSteps, 1);
  return out;
}

/// Normal equations of a small motion of a model: first turned about its origin, then moved, both
/// along the world's axes.
struct Equations {
  Matrix6 a = Matrix6::Zero();
  Vector6 g = Vector6::Zero();
  std::size_t rows = 0;

  void add(const std::vector<CorrespondenceLine>& all, const TileCamera& camera,
           const Eigen::Isometry3d& world_from_model) {
    const Eigen::Matrix3d turn = camera.camera_from_world.linear();
    for (const CorrespondenceLine& line : all) {
      const Eigen::Vector3d arm = world_from_model.linear() * line.position.cast<double>();
      const Eigen::Vector3d at = camera.camera_from_world * (world_from_model.translation() + arm);
      const Eigen::Vector3d slope = turn.transpose() * pixel_slope(camera, at, line.normal);
      Vector6 row;
      row << arm.cross(slope), slope;
      const double weight = 1 / double{line.variance};
      add(row, weight, -double{line.mean});
    }
    rows += all.size();
  }

  void add(const std::vector<DepthMatch>& all, double sigma,
           const Eigen::Isometry3d& world_from_model) {
    for (const DepthMatch& match : all) {
      const Eigen::Vector3d arm = world_from_model.linear() * match.model.position.cast<double>();
      const Eigen::Vector3d normal = world_from_model.linear() * match.model.normal.cast<double>();
      Vector6 row;
      row << arm.cross(normal), normal;
      const double weight = 1 / (sigma * sigma);
      add(row, weight, -beyond(match, world_from_model));
    }
    rows += all.size();
  }

  void add(const Vector6& row, double weight, double residual) {
    const Vector6 weighted = weight * row;
    a += weighted * row.transpose();
    g += residual * weighted;
  }

  Vector6 solve() const {
    Matrix6 damped = a;
    damped.diagonal().head<3>().array() += 1 / (kTurn * kTurn);
    damped.diagonal().tail<3>().array() += 1 / (kMove * kMove);
    return damped.ldlt().solve(-g);
  }
};

void move(Eigen::Isometry3d& pose, const Vector6& by) {
  const double angle = by.head<3>().norm();
  if (angle > 0) pose.linear() = Eigen::AngleAxisd(angle, by.head<3>() / angle) * pose.linear();
  pose.translation() += by.tail<3>();
}

}  // namespace

std::vector<CorrespondenceLine> lines_of(const ContourViews& model,
                                         const Eigen::Isometry3d& world_from_model,
                                         const RegionView& view, int scale) {
  const Eigen::Isometry3f camera_from_model =
      (view.camera->camera_from_world * world_from_model).cast<float>();
  return find_lines(model.seen_by(camera_from_model), camera_from_model, view, scale);
}

Eigen::Isometry3d fit_region(const ContourViews& model, Eigen::Isometry3d world_from_model,
                             const std::vector<RegionView>& views, const DepthViews& depth) {
  if (views.empty()) return world_from_model;
  Eigen::Isometry3d pose = world_from_model;
  const TileCamera& first = *views.front().camera;
  const Eigen::Isometry3f seen = (first.camera_from_world * pose).cast<float>();
  for (const int scale : scales(extent_of(model, seen, first))) {
    Equations equations;
    for (const RegionView& view : views)
      equations.add(lines_of(model, pose, view, scale), *view.camera, pose);
    for (const TileView* view : depth.views)
      equations.add(match_depth(depth.points, pose, *view), depth.sigma, pose);
    if (equations.rows < kLeastRows) return world_from_model;
    move(pose, equations.solve());
  }
  return pose.matrix().allFinite() ? pose : world_from_model;
}

}  // namespace hypotrack::contour
