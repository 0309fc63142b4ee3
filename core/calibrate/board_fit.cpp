#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "calibrate/board/corner_noise.hpp"
#include "calibrate/stereo_calibration.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack::calibrate {
namespace {

/// Corners that both pictures show, by column.
struct CornerColumns {
  Eigen::Matrix3Xd board;
  std::array<Eigen::Matrix2Xd, 2> pixels;
};

CornerColumns columns_of(const SharedCorners& shared) {
  const auto count = std::ssize(shared.board);
  CornerColumns out{Eigen::Matrix3Xd(3, count),
                    {Eigen::Matrix2Xd(2, count), Eigen::Matrix2Xd(2, count)}};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    out.board.col(i) << shared.board[at].x, shared.board[at].y, shared.board[at].z;
    for (std::size_t view = 0; view < 2; ++view)
      out.pixels[view].col(i) << shared.at[view][at].x, shared.at[view][at].y;
  }
  return out;
}

/// Returns the points nearest to the rays of both cameras, in the world.
Eigen::Matrix3Xd triangulated(const std::array<Camera, 2>& cameras, const CornerColumns& corners) {
  std::array<Eigen::Matrix3Xd, 2> rays;
  std::array<Eigen::Vector3d, 2> origins;
  for (std::size_t view = 0; view < 2; ++view) {
    const Eigen::Isometry3d world_from_camera = cameras[view].camera_from_world.inverse();
    rays[view] = world_from_camera.linear() * back_project(cameras[view], corners.pixels[view]);
    origins[view] = world_from_camera.translation();
  }
  Eigen::Matrix3Xd out(3, corners.board.cols());
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    Eigen::Matrix<double, 3, 2> both;
    both << rays[0].col(i), -rays[1].col(i);
    const Eigen::Vector2d lengths = both.colPivHouseholderQr().solve(origins[1] - origins[0]);
    out.col(i) =
        (origins[0] + lengths[0] * rays[0].col(i) + origins[1] + lengths[1] * rays[1].col(i)) / 2;
  }
  return out;
}

/// Pose and logarithm of the scale of a board: rotation vector, translation, scale.
using Placement = Eigen::Matrix<double, 7, 1>;

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle <= 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

Eigen::VectorXd residuals(const std::array<Camera, 2>& cameras, const CornerColumns& corners,
                          const Placement& at) {
  const Eigen::Matrix3d turn = std::exp(at[6]) * rotation_of(at.head<3>());
  const Eigen::Index count = corners.board.cols();
  Eigen::VectorXd out(4 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d point = turn * corners.board.col(i) + at.segment<3>(3);
    for (std::size_t view = 0; view < 2; ++view)
      out.segment<2>(4 * i + 2 * static_cast<Eigen::Index>(view)) =
          project(cameras[view], point) - corners.pixels[view].col(i);
  }
  return out;
}

/// Refines a placement with Gauss-Newton steps and numerical derivatives.
Placement refined(const std::array<Camera, 2>& cameras, const CornerColumns& corners,
                  Placement at) {
  constexpr int kSteps = 8;
  constexpr double kDifference = 1e-6;
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::VectorXd now = residuals(cameras, corners, at);
    Eigen::MatrixXd jacobian(now.size(), at.size());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      Placement moved = at;
      moved[i] += kDifference;
      jacobian.col(i) = (residuals(cameras, corners, moved) - now) / kDifference;
    }
    if (!jacobian.allFinite()) return at;
    const Placement change = jacobian.colPivHouseholderQr().solve(now);
    at -= change;
  }
  return at;
}

}  // namespace

std::optional<BoardFit> fit_board(const BoardFinder& finder, const std::array<Camera, 2>& cameras,
                                  const BoardPair& pair) {
  const CornerColumns corners = columns_of(shared_corners(finder, pair));
  const Eigen::Index count = corners.board.cols();
  if (count < static_cast<Eigen::Index>(kLeastCorners)) return std::nullopt;
  const Eigen::Matrix3Xd points = triangulated(cameras, corners);
  const Eigen::Vector3d middle = cameras[0].camera_from_world * points.rowwise().mean();
  if (!points.allFinite() || middle.z() <= 0) return std::nullopt;
  const Eigen::Matrix4d similar = Eigen::umeyama(corners.board, points, true);
  const double scale = similar.topLeftCorner<3, 1>().norm();
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(similar.topLeftCorner<3, 3>() / scale));
  Placement start;
  start << turn.angle() * turn.axis(), similar.topRightCorner<3, 1>(), std::log(scale);
  const Placement found = refined(cameras, corners, start);
  const Eigen::VectorXd left = residuals(cameras, corners, found);
  if (!left.allFinite()) return std::nullopt;
  BoardFit out;
  out.scale = std::exp(found[6]);
  out.rms = std::sqrt(left.squaredNorm() / static_cast<double>(2 * count));
  out.expected = expected_distance(pair);
  out.depth = middle.z();
  const Eigen::Vector2d centre = corners.pixels[0].rowwise().mean();
  out.centre = {centre.x() / cameras[0].width, centre.y() / cameras[0].height};
  return out;
}

}  // namespace hypotrack::calibrate
