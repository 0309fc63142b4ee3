#include "mechanism.hpp"

#include <fmt/format.h>

#include <cmath>

#include "drives.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::articulated {
namespace {

/// Returns the motion of a joint by an amount, as a transform of its child.
Eigen::Isometry3d motion(JointKind kind, const Eigen::Vector3d& axis, double amount) {
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  if (kind == JointKind::prismatic) {
    moved.translate(amount * axis);
  } else {
    moved.rotate(Eigen::AngleAxisd(amount, axis));
  }
  return moved;
}

/// Adds the bone of a link that a joint moves against its parent.
int add_bone(ModelData& data, const std::string& link, const Joint& joint, const LinkPlace& parent,
             const Drive& drive, const std::string& where) {
  const double length = joint.axis.norm();
  if (!(length > 0) || !std::isfinite(length))
    throw DataError(fmt::format("{}: joint '{}' has an axis of length {}; give it a direction",
                                where, joint.name, length));
  const Eigen::Vector3d axis = joint.axis / length;
  const auto bone = static_cast<int>(data.bones.size());
  Eigen::Isometry3d at_bind = parent.bone_from_link * joint.parent_from_child;
  if (drive.multiplier == 0) {  // such a joint never moves
    at_bind = at_bind * motion(joint.kind, axis, drive.offset - joint.bind);
  } else {
    data.motions.push_back(
        {bone, drive.parameter, axis, (joint.bind - drive.offset) / drive.multiplier,
         drive.multiplier,
         joint.kind == JointKind::prismatic ? MotionKind::translation : MotionKind::rotation});
  }
  data.bones.push_back({link, parent.bone, at_bind});
  return bone;
}

}  // namespace

Assembly assemble(const Mechanism& mechanism, const std::string& where) {
  const std::vector<TreeLink> order = order_links(mechanism, where);
  const Drives drives(mechanism.joints, where);
  Assembly out;
  out.data.parameters = drives.parameters();
  out.links.resize(mechanism.links.size());
  for (const TreeLink& link : order) {
    const std::string& name = mechanism.links[link.link];
    LinkPlace& place = out.links[link.link];
    if (!link.joint) {
      out.data.bones.push_back({name, -1, Eigen::Isometry3d::Identity()});
      continue;
    }
    const LinkPlace& parent = out.links[order[static_cast<std::size_t>(link.parent)].link];
    if (link.joint->kind == JointKind::fixed) {
      place = {parent.bone, parent.bone_from_link * link.joint->parent_from_child};
    } else {
      place.bone = add_bone(out.data, name, *link.joint, parent, drives.of(*link.joint), where);
    }
  }
  return out;
}

}  // namespace hypotrack::articulated
