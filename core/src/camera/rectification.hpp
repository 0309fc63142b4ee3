#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Largest rotation of each optical axis by which a pair is still rectified. The rotation makes
/// both axes parallel and perpendicular to the baseline. The limit admits pairs with any roll,
/// vertical pairs (whose tiles are rotated by a right angle), and toed-in pairs with up to twice
/// this angle between the axes. It refuses wide-angle arrangements and one camera behind the other.
inline constexpr double kRectifyLimit = 15.0 * 3.14159265358979323846 / 180.0;  // radians
/// Shortest baseline (metres) that defines a direction of rectification.
inline constexpr double kShortestBaseline = 1e-4;

/// The undistorted cameras that tiles are resampled for. Their centres are the real ones; their
/// orientations are shared (rectified) or the real ones.
struct IdealRig {
  bool rectified = false;
  std::vector<Eigen::Isometry3d> ideal_from_world;
  std::vector<Eigen::Matrix3d> camera_from_ideal;  ///< rotations
};

/// Makes the ideal cameras: rectified for two near-parallel cameras, otherwise with each camera's
/// own axes. In a rectified rig, a point has the same y/z in both cameras, and x_first/z -
/// x_second/z is baseline/z, never negative.
/// Source: Fusiello, Trucco and Verri, 2000: x points from the first camera to the second; z is as
/// close to the mean optical axis as that allows.
IdealRig make_ideal_rig(std::span<const Camera> cameras);

}  // namespace internal
}  // namespace hypotrack
