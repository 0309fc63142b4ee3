#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rigging.hpp"

namespace hypotrack {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSmallestBend = 2 * kDegree;

/// Returns the normal of the plane in which the finger is bent at the bind pose.
Vector3d bend_axis(const Rigging& r, std::size_t index, int parent, const Matrix3d& zero,
                   const Vector3d& y) {
  Vector3d axis;
  if (moving_parent(r, parent) > 0) {
    axis = r.hand_from_bone[static_cast<std::size_t>(parent)].linear().col(1).cross(y);
  } else {
    const RigBone& bone = r.rig.bones[index];
    const auto child = std::find_if(r.rig.bones.begin(), r.rig.bones.end(),
                                    [&](const RigBone& b) { return b.parent == bone.name; });
    if (child == r.rig.bones.end()) r.fail(fmt::format("bone '{}' has no next joint", bone.name));
    const Vector3d joint = joint_of(r, *child);
    const auto next = static_cast<std::size_t>(child - r.rig.bones.begin());
    axis = y.cross((end_of(r, next, joint) - joint).normalized());
  }
  if (axis.norm() < std::sin(kSmallestBend)) {
    r.fail(
        fmt::format("bone '{}' is bent by only {:.2g} degrees in the file, too little to tell its "
                    "flexion axis: say `flexion_axis: hand` or an axis of the file's bone",
                    r.rig.bones[index].name, std::asin(axis.norm()) / kDegree));
  }
  return axis.dot(zero.col(0)) < 0 ? Vector3d(-axis) : axis;
}

/// Returns the parent's flexion axis, turned by the abduction only.
Vector3d hand_axis(const Matrix3d& zero, const Vector3d& y) {
  const Vector3d d = zero.transpose() * y;
  const double abduction = std::atan2(d.x(), d.y());
  return zero * Vector3d(std::cos(abduction), -std::sin(abduction), 0);
}

/// Returns an axis of the file bone at which a bone begins.
Vector3d joint_axis(const Rigging& r, const RigBone& bone, const std::string& name) {
  const auto local = axis_by_name(name);
  if (!local) {
    r.fail(
        fmt::format("`flexion_axis` of bone '{}' is '{}': it must be hand, bend, x, -x, y, -y, z "
                    "or -z",
                    bone.name, name));
  }
  if (bone.joint.empty()) {
    r.fail(
        fmt::format("bone '{}' has no `joint` whose axis '{}' could be; say `flexion_axis: "
                    "hand` or `bend`",
                    bone.name, name));
  }
  // A mirrored rotation axis is a pseudovector: two of its components change sign.
  const Vector3d axis =
      r.rig.side == Side::left ? Vector3d(local->x(), -local->y(), -local->z()) : *local;
  return r.in.bones[r.file_bone(bone.joint, who(bone))].file_from_bone.linear() * axis;
}

}  // namespace

Vector3d flexion_axis(const Rigging& r, std::size_t index, int parent, const Matrix3d& zero,
                      const Vector3d& y) {
  const RigBone& bone = r.rig.bones[index];
  const std::string& source = bone.flexion_axis.empty() ? r.rig.flexion_axis : bone.flexion_axis;
  const Vector3d axis = source == "hand"   ? hand_axis(zero, y)
                        : source == "bend" ? bend_axis(r, index, parent, zero, y)
                                           : joint_axis(r, bone, source);
  if (!(axis.cross(y).norm() > std::sin(kSmallestBend))) {
    r.fail(fmt::format("the flexion axis of bone '{}' runs along the bone", bone.name));
  }
  return axis;
}

}  // namespace hypotrack
