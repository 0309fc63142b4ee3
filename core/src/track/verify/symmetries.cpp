
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "track/verify/surface_points.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the 24 rotations that put a cube onto itself.
std::vector<Eigen::Matrix3d> turns_of_a_cube() {
  std::vector<Eigen::Matrix3d> out;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int signs = 0; signs < 4; ++signs) {
        if (x == y) continue;
        Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
        turn(x, 0) = (signs & 1) != 0 ? -1 : 1;
        turn(y, 1) = (signs & 2) != 0 ? -1 : 1;
        turn.col(2) = turn.col(0).cross(turn.col(1));
        out.push_back(turn);
      }
  return out;
}

/// Returns the mean distance of some points, turned, from the nearest of all of them.
double mean_distance(const Eigen::Matrix3Xf& points, const Eigen::Matrix3f& turn) {
  constexpr Eigen::Index kTried = 200;
  const Eigen::Index every = std::max<Eigen::Index>(1, points.cols() / kTried);
  double sum = 0;
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < points.cols(); i += every, ++count) {
    const Eigen::Vector3f at = turn * points.col(i);
    sum += std::sqrt(double{(points.colwise() - at).colwise().squaredNorm().minCoeff()});
  }
  return sum / static_cast<double>(count);
}

}  // namespace

std::vector<Eigen::Isometry3d> symmetries(const Mesh& mesh) {
  constexpr Eigen::Index kPoints = 2000;
  constexpr double kSame = 0.03;   // of the mesh's size, mean distance from itself
  constexpr double kEqual = 0.35;  // difference of two rotations, which are then one
  const SurfacePoints spread = spread_points(mesh, kPoints);
  if (spread.count() == 0) return {};
  const Eigen::Matrix3Xf surface = positions(spread, mesh.vertices);
  const Eigen::Vector3f center = surface.rowwise().mean();
  const Eigen::Matrix3Xf points = surface.colwise() - center;
  const double size = std::sqrt(double{points.squaredNorm()} / static_cast<double>(kPoints));
  const Eigen::Matrix3d spreads = (points * points.transpose()).cast<double>();
  Eigen::Matrix3d inertia = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spreads).eigenvectors();
  inertia.col(2) = inertia.col(0).cross(inertia.col(1));

  // Turned points do not fall onto others, even of a surface that stays the same.
  constexpr double kSpacing = 0.5;
  const double most =
      kSame * size + kSpacing * std::sqrt(spread.area / static_cast<double>(kPoints));
  std::vector<Eigen::Matrix3d> found{Eigen::Matrix3d::Identity()};
  for (const Eigen::Matrix3d& axes : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), inertia})
    for (const Eigen::Matrix3d& of_cube : turns_of_a_cube()) {
      const Eigen::Matrix3d turn = axes * of_cube * axes.transpose();
      const bool known = std::ranges::any_of(
          found, [&](const Eigen::Matrix3d& other) { return (turn - other).norm() < kEqual; });
      if (!known && mean_distance(points, turn.cast<float>()) < most) found.push_back(turn);
    }
  std::vector<Eigen::Isometry3d> out;
  for (std::size_t i = 1; i < found.size(); ++i) {
    const Eigen::Vector3d about = center.cast<double>();
    Eigen::Isometry3d motion(found[i]);
    motion.pretranslate(Eigen::Vector3d(about - found[i] * about));
    out.push_back(motion);
  }
  return out;
}

}  // namespace hypotrack::internal
