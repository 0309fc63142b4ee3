#include <algorithm>
#include <cmath>
#include <map>

#include "rigging.hpp"

namespace hypotrack {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d rotation(const BoneAngles& angles) {
  return (AngleAxisd(-angles.abduction, Vector3d::UnitZ()) *
          AngleAxisd(angles.twist, Vector3d::UnitY()) *
          AngleAxisd(angles.flexion, Vector3d::UnitX()))
      .toRotationMatrix();
}

// Yaw, pitch and roll.
BoneAngles angles_of(const Matrix3d& r) {
  return {-std::atan2(r(1, 0), r(0, 0)), std::asin(std::clamp(-r(2, 0), -1.0, 1.0)),
          std::atan2(r(2, 1), r(2, 2))};
}

std::optional<Vector3d> axis_by_name(const std::string& name) {
  static const std::map<std::string, Vector3d> kAxes = {
      {"x", Vector3d::UnitX()},   {"-x", -Vector3d::UnitX()}, {"y", Vector3d::UnitY()},
      {"-y", -Vector3d::UnitY()}, {"z", Vector3d::UnitZ()},   {"-z", -Vector3d::UnitZ()}};
  const auto found = kAxes.find(name);
  return found == kAxes.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace hypotrack
