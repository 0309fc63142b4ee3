#include <fmt/format.h>

#include "rigging.hpp"

namespace hypotrack {
namespace {

using Eigen::Vector3d;

Vector3d file_point(const Rigging& r, const std::vector<double>& point, const std::string& key) {
  if (point.size() != 3) {
    r.fail(fmt::format("{} has {} numbers instead of three", key, point.size()));
  }
  Vector3d p = Eigen::Map<const Vector3d>(point.data()) * r.rig.scale;
  if (r.rig.side == Side::left) p.x() = -p.x();
  p = r.hand_from_file * p;
  const auto& vertices = r.in.mesh.vertices;
  const Vector3d low = vertices.rowwise().minCoeff().cast<double>();
  const Vector3d high = vertices.rowwise().maxCoeff().cast<double>();
  const double size = (high - low).norm();
  if (!((p - (low + high) / 2).norm() <= 2 * size)) {
    r.fail(
        fmt::format("{} is {:.3g} m from the middle of the mesh, which is {:.3g} m long; expected "
                    "a point of the hand, in the file's units",
                    key, (p - (low + high) / 2).norm(), size));
  }
  return p;
}

/// Returns the vertex farthest from `joint` among the vertices that mostly follow a bone of the
/// rig.
Vector3d farthest_vertex(const Rigging& r, int bone, const Vector3d& joint) {
  Vector3d farthest = joint;
  for (Eigen::Index v = 0; v < r.in.mesh.vertices.cols(); ++v) {
    const Vector3d p = r.in.mesh.vertices.col(v).cast<double>();
    float held = 0;
    for (int k = 0; k < 4; ++k) {
      if (r.in.mesh.bone_indices(k, v) == bone) {
        held += r.in.mesh.bone_weights(k, v);
      }
    }
    if (held > 0.5f && (p - joint).norm() > (farthest - joint).norm()) farthest = p;
  }
  return farthest;
}

}  // namespace

Vector3d joint_of(const Rigging& r, const RigBone& bone) {
  if (bone.joint.empty() && bone.joint_at.empty()) {
    r.fail(fmt::format("bone '{}' needs a `joint` (a bone of the file) or `joint_at`", bone.name));
  }
  if (!bone.joint_at.empty()) {
    return file_point(r, bone.joint_at, fmt::format("`joint_at` of bone '{}'", bone.name));
  }
  return r.in.bones[r.file_bone(bone.joint, who(bone) + ", `joint`,")].file_from_bone.translation();
}

Vector3d end_of(const Rigging& r, std::size_t index, const Vector3d& joint) {
  const RigBone& bone = r.rig.bones[index];
  if (!bone.end_at.empty()) {
    return file_point(r, bone.end_at, fmt::format("`end_at` of bone '{}'", bone.name));
  }
  if (!bone.end.empty()) {
    return r.in.bones[r.file_bone(bone.end, who(bone) + ", `end`,")].file_from_bone.translation();
  }
  return farthest_vertex(r, static_cast<int>(index), joint);
}

}  // namespace hypotrack
