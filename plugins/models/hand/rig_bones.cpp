#include <fmt/format.h>

#include "rigging.hpp"

namespace hypotrack {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

int parent_of(const Rigging& r, std::size_t index) {
  const RigBone& bone = r.rig.bones[index];
  if (bone.parent.empty()) {
    r.fail(fmt::format("bone '{}' has no parent; only the first bone, '{}', may be the root",
                       bone.name, r.rig_names[0]));
  }
  const int parent = r.rig_bone(bone.parent, who(bone) + ", `parent`,");
  if (parent >= static_cast<int>(index)) {
    r.fail(
        fmt::format("the parent of bone '{}' is '{}', which comes later or is itself: parents "
                    "come before their children, without cycles",
                    bone.name, bone.parent));
  }
  return parent;
}

void add_root(Rigging& r, const RigBone& bone) {
  if (!bone.parent.empty() || !bone.abduction.empty() || !bone.flexion.empty()) {
    r.fail(fmt::format("the first bone, '{}', is the root: it has no parent and no parameters",
                       bone.name));
  }
  r.data.bones.push_back({bone.name, -1, Isometry3d::Identity()});
  r.hand_from_bone.push_back(Isometry3d::Identity());
  r.ends.push_back(Vector3d::Zero());
}

void place_bone(Rigging& r, std::size_t index, int parent, const Vector3d& joint,
                const Vector3d& y) {
  const RigBone& bone = r.rig.bones[index];
  const Matrix3d zero =
      r.hand_from_bone[static_cast<std::size_t>(moving_parent(r, parent))].linear() *
      rotation({bone.zero[0], bone.zero[1], bone.zero[2]});
  Vector3d x = flexion_axis(r, index, parent, zero, y);
  x = Eigen::AngleAxisd(bone.twist, y) * (x - x.dot(y) * y).normalized();
  Isometry3d hand_from_bone = Isometry3d::Identity();
  hand_from_bone.linear() << x, y, x.cross(y);
  hand_from_bone.translation() = joint;
  const Isometry3d& hand_from_parent = r.hand_from_bone[static_cast<std::size_t>(parent)];
  r.data.bones.push_back({bone.name, parent, hand_from_parent.inverse() * hand_from_bone});
  r.hand_from_bone.push_back(hand_from_bone);
  const BoneAngles bind = angles_of(zero.transpose() * hand_from_bone.linear());
  const Matrix3d after_abduction = rotation({0, bind.twist, bind.flexion});
  drive(r, index, bone.abduction, after_abduction.transpose() * -Vector3d::UnitZ(), bind.abduction);
  drive(r, index, bone.flexion, Vector3d::UnitX(), bind.flexion);
}

}  // namespace

int moving_parent(const Rigging& r, int parent) {
  while (parent > 0 && r.rig.bones[static_cast<std::size_t>(parent)].abduction.empty() &&
         r.rig.bones[static_cast<std::size_t>(parent)].flexion.empty()) {
    parent = r.data.bones[static_cast<std::size_t>(parent)].parent;
  }
  return parent;
}

void add_bone(Rigging& r, std::size_t index) {
  const RigBone& bone = r.rig.bones[index];
  if (index == 0) return add_root(r, bone);
  const int parent = parent_of(r, index);
  const Vector3d joint = joint_of(r, bone);
  const Vector3d end = end_of(r, index, joint);
  if (!((end - joint).norm() > kSameThing)) {
    r.fail(fmt::format("bone '{}' begins and ends in the same place", bone.name));
  }
  r.ends.push_back(end);
  place_bone(r, index, parent, joint, (end - joint).normalized());
}

}  // namespace hypotrack
