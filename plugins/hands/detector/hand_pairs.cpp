#include "hand_pairs.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::hands {
namespace {

/// Rays of landmarks in the world.
struct Rays {
  Rays(const Camera& camera, const HandPoints& points) {
    const Eigen::Isometry3d world_from_camera = camera.camera_from_world.inverse();
    origin = world_from_camera.translation();
    directions = world_from_camera.linear() * back_project(camera, points);
  }
  Eigen::Vector3d origin;
  HandPoints3D directions;  ///< depth 1 in the camera
};

/// Returns the median distance of reprojected landmarks from those seen, as a share of the hand's
/// size in the picture; infinite if more than a third is unknown.
double reprojection_error(const Camera& camera, const HandPoints3D& landmarks,
                          const HandPoints& seen) {
  std::vector<double> errors;
  for (Eigen::Index i = 0; i < seen.cols(); ++i) {
    const double error = (project(camera, landmarks.col(i)) - seen.col(i)).norm();
    if (std::isfinite(error)) errors.push_back(error);
  }
  if (3 * std::ssize(errors) < 2 * seen.cols()) return std::numeric_limits<double>::infinity();
  return upper_median(std::move(errors)) / size_of(seen);
}

/// Returns the probability of a right hand from those of two views.
double both_right(double a, double b) {
  const double right = a * b, left = (1 - a) * (1 - b);
  return right + left > 0 ? right / (right + left) : 0.5;
}

/// Returns whether triangulated landmarks have the size of a hand, a child's to a large man's.
bool has_size_of_hand(const HandPoints3D& landmarks) {
  constexpr double kShortest = 0.05, kLongest = 0.165;  // wrist to middle knuckle, metres
  const double palm = (landmarks.col(9) - landmarks.col(0)).norm();
  return palm > kShortest && palm < kLongest;
}

}  // namespace

HandPoints3D triangulate(const std::array<Camera, 2>& cameras, const HandPoints& first,
                         const HandPoints& second) {
  const Rays a(cameras[0], first), b(cameras[1], second);
  HandPoints3D out;
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    const Eigen::Vector3d u = a.directions.col(i), v = b.directions.col(i);
    const Eigen::Vector3d apart = b.origin - a.origin;
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
    const double sine = uu * vv - uv * uv;
    const double s = (vv * u.dot(apart) - uv * v.dot(apart)) / sine;
    const double t = (uv * u.dot(apart) - uu * v.dot(apart)) / sine;
    if (s > 0 && t > 0 && sine > 1e-12)
      out.col(i) = (a.origin + s * u + b.origin + t * v) / 2;
    else
      out.col(i).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

std::vector<HandPair> pair_hands(const std::array<Camera, 2>& cameras,
                                 std::span<const HandDetection> first,
                                 std::span<const HandDetection> second) {
  constexpr double kWorst = 0.06;  // reprojection error
  struct Possible {
    std::size_t i, j;
    double cost;
    HandPair pair;
  };
  std::vector<Possible> all;
  for (std::size_t i = 0; i < first.size(); ++i)
    for (std::size_t j = 0; j < second.size(); ++j) {
      const HandDetection &a = first[i], &b = second[j];
      HandPair pair{triangulate(cameras, a.landmarks, b.landmarks), both_right(a.right, b.right)};
      pair.error = std::max(reprojection_error(cameras[0], pair.landmarks, a.landmarks),
                            reprojection_error(cameras[1], pair.landmarks, b.landmarks));
      if (!(pair.error < kWorst) || !has_size_of_hand(pair.landmarks)) continue;
      const double differ = std::abs(a.right - b.right);
      all.push_back({i, j, pair.error + kWorst * differ, std::move(pair)});
    }
  std::ranges::stable_sort(all, {}, &Possible::cost);
  std::vector<HandPair> out;
  std::vector<bool> used_first(first.size(), false), used_second(second.size(), false);
  for (Possible& one : all) {
    if (used_first[one.i] || used_second[one.j]) continue;
    used_first[one.i] = used_second[one.j] = true;
    out.push_back(std::move(one.pair));
  }
  return out;
}

}  // namespace hypotrack::hands
