#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack {

/// A pair is rectified if turning each camera's optical axis by at most this much makes both axes
/// parallel and perpendicular to the baseline. It admits toed-in pairs (up to twice the angle
/// between the axes) and vertical ones (their tiles are then turned by a right angle), any roll,
/// and refuses wide-angle arrangements and one camera behind the other.
inline constexpr double kRectifyLimit = 15.0 * 3.14159265358979323846 / 180.0;  // radians
/// Cameras nearer to each other than this (metres) have no direction to rectify along.
inline constexpr double kShortestBaseline = 1e-4;

/// The undistorted cameras that tiles are cut from: same centres as the real ones, and orientations
/// that are shared (rectified) or the real ones.
struct IdealRig {
  bool rectified = false;
  std::vector<Eigen::Isometry3d> ideal_from_world;
  std::vector<Eigen::Matrix3d> camera_from_ideal;  ///< rotations
};

/// Rectified (Fusiello, Trucco and Verri, 2000: x along the baseline from the first camera to the
/// second, z as near to the mean optical axis as that allows) for two near-parallel cameras;
/// otherwise every camera keeps its own axes. For a rectified rig a point has the same y/z in both,
/// and x_first/z - x_second/z is baseline/z, never negative.
HYPOTRACK_API IdealRig make_ideal_rig(std::span<const Camera> cameras);

}  // namespace hypotrack
