#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace hypotrack {

/// The three angles of a bone in its zero frame (rig.hpp, "Angles"), radians.
struct BoneAngles {
  double abduction = 0;
  double twist = 0;
  double flexion = 0;
};

Eigen::Matrix3d rotation(const BoneAngles& angles);

/// Returns the angles of a rotation; inverse of rotation().
BoneAngles angles_of(const Eigen::Matrix3d& r);

/// Returns the unit vector called x, -x, y, -y, z or -z; nothing for every other name.
std::optional<Eigen::Vector3d> axis_by_name(const std::string& name);

}  // namespace hypotrack
