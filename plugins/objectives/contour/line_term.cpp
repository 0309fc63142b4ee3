#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/model.hpp"
#include "terms.hpp"

namespace hypotrack::contour {
namespace {

constexpr double kBefore = 0.01;  // metres from the camera; nothing nearer is drawn either

/// Returns the distance in pixels of a point from a line's mean; infinite at or behind the camera.
double distance(const LineSet& set, const CorrespondenceLine& line, const Eigen::Vector3d& at) {
  if (!(at.z() > kBefore)) return std::numeric_limits<double>::infinity();
  const TileCamera& camera = set.camera;
  const Eigen::Vector2d pixel(camera.fx * at.x() / at.z() + camera.cx,
                              camera.fy * at.y() / at.z() + camera.cy);
  return line.normal.cast<double>().dot(pixel - line.centre.cast<double>()) - line.mean;
}

double residual(const LineSet& set, const CorrespondenceLine& line, double d) {
  const double scale = std::sqrt(set.weight / line.variance);
  if (std::isinf(d)) return scale * set.reach;
  return scale * d / std::hypot(1, d / set.reach);
}

std::span<const double> pose_of(const LineSet& set, std::span<const double> state) {
  return state.subspan(static_cast<std::size_t>(set.offset), kPoseSize);
}

/// Normal equations of a small motion of one model (turned about its origin, then moved) and of the
/// turn of the second camera.
class TurnEquations {
 public:
  void add(const LineSet& set, const Eigen::Isometry3d& world_from_model) {
    const Eigen::Matrix3d world_from_camera = set.camera.camera_from_world.linear().transpose();
    for (const CorrespondenceLine& line : set.lines) {
      const Eigen::Vector3d arm = world_from_model.linear() * line.position.cast<double>();
      const Eigen::Vector3d at =
          set.camera.camera_from_world * (world_from_model.translation() + arm);
      const double d = distance(set, line, at);
      if (std::isinf(d)) continue;
      const Eigen::Vector3d slope = pixel_slope(set.camera, at, line.normal);
      const Eigen::Vector3d moved = world_from_camera * slope;
      const bool turns = set.view == 1;
      Row row;
      row << arm.cross(moved), moved, turns ? slope.x() * at.z() - slope.z() * at.x() : 0.0;
      const double bend = std::hypot(1, d / set.reach);
      const double weight = 1 / (double{line.variance} * bend * bend * bend * bend);
      a_ += weight * row * row.transpose();
      g_ += weight * d * row;
      if (turns) depths_ += at.z();
      if (set.view < lines_.size()) ++lines_[set.view];
    }
  }

  /// Adds what is known of the turn, whatever the model's motion, to a sum of angles by their
  /// information.
  void add_to(CameraTurn& sum, double& information) const {
    if (lines_[0] == 0 || lines_[1] == 0) return;
    Eigen::Matrix<double, 6, 6> motion = a_.topLeftCorner<6, 6>();
    motion.diagonal().array() += 1;  // radians and metres: motions that no line tells are bounded
    const Eigen::Matrix<double, 6, 1> by_turn = motion.ldlt().solve(a_.col(6).head<6>());
    const double own = a_(6, 6) - by_turn.dot(a_.col(6).head<6>());
    information += own;
    sum.angle -= g_[6] - by_turn.dot(g_.head<6>());
    sum.distance += own * depths_ / lines_[1];
  }

 private:
  using Row = Eigen::Matrix<double, 7, 1>;
  Eigen::Matrix<double, 7, 7> a_ = Eigen::Matrix<double, 7, 7>::Zero();
  Row g_ = Row::Zero();
  std::array<int, 2> lines_{};  ///< by view
  double depths_ = 0;           ///< sum over the second view's lines
};

}  // namespace

Eigen::Vector3d pixel_slope(const TileCamera& camera, const Eigen::Vector3d& point,
                            const Eigen::Vector2f& direction) {
  const double x = camera.fx * double{direction.x()} / point.z();
  const double y = camera.fy * double{direction.y()} / point.z();
  return {x, y, -(x * point.x() + y * point.y()) / point.z()};
}

std::int64_t residual_count(std::span<const LineSet> sets) {
  std::int64_t count = 0;
  for (const LineSet& set : sets) count += std::ssize(set.lines);
  return count;
}

double cost_and_residuals(std::span<const LineSet> sets, std::span<const double> state,
                          std::span<float> residuals) {
  double cost = 0;
  std::size_t i = 0;
  for (const LineSet& set : sets) {
    const Eigen::Isometry3d camera_from_model =
        set.camera.camera_from_world * world_from_model(pose_of(set, state));
    for (const CorrespondenceLine& line : set.lines) {
      const double r = residual(
          set, line, distance(set, line, camera_from_model * line.position.cast<double>()));
      cost += r * r;
      if (!residuals.empty()) residuals[i++] = static_cast<float>(r);
    }
  }
  return cost;
}

void write_jacobian(std::span<const LineSet> sets, std::span<const double> state,
                    Jacobian& jacobian) {
  Eigen::Index i = 0;
  for (const LineSet& set : sets) {
    const std::span<const double> pose = pose_of(set, state);
    const Eigen::Isometry3d model = world_from_model(pose);
    for (const CorrespondenceLine& line : set.lines) {
      const Eigen::Vector3d x = line.position.cast<double>();
      const Eigen::Vector3d at = set.camera.camera_from_world * (model * x);
      const double d = distance(set, line, at);
      auto row = jacobian.row(i++).segment<kPoseSize>(set.offset);
      if (std::isinf(d)) continue;
      const double bend = std::hypot(1, d / set.reach);
      const double scale = std::sqrt(set.weight / line.variance) / (bend * bend * bend);
      const Eigen::RowVector3d slope = scale * (set.camera.camera_from_world.linear().transpose() *
                                                pixel_slope(set.camera, at, line.normal))
                                                   .transpose();
      row.head<3>() = slope.cast<float>();
      row.tail<4>() = (slope * quaternion_slopes(pose.subspan<3, 4>(), x)).cast<float>();
    }
  }
}

std::optional<CameraTurn> camera_turn(std::span<const LineSet> sets,
                                      std::span<const double> state) {
  CameraTurn sum;
  double information = 0;
  for (auto first = sets.begin(); first != sets.end();) {
    const int offset = first->offset;
    const Eigen::Isometry3d pose = world_from_model(pose_of(*first, state));
    TurnEquations equations;
    for (; first != sets.end() && first->offset == offset; ++first) equations.add(*first, pose);
    equations.add_to(sum, information);
  }
  if (!(information > 0)) return std::nullopt;
  return CameraTurn{sum.angle / information, 1 / std::sqrt(information),
                    sum.distance / information};
}

}  // namespace hypotrack::contour
