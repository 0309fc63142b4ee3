#include <fmt/format.h>

#include "rigging.hpp"

namespace hypotrack {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d file_axis(const Rigging& r, const std::string& name, const char* key) {
  const auto axis = axis_by_name(name);
  if (!axis) {
    r.fail(fmt::format("`frame: {}` is '{}': it must be x, -x, y, -y, z or -z", key, name));
  }
  return r.rig.side == Side::left ? Vector3d(-axis->x(), axis->y(), axis->z()) : *axis;
}

Vector3d joint_in_file(const Rigging& r, const std::string& name, const char* key) {
  return r.in.bones[r.file_bone(name, fmt::format("`frame: {}`", key))]
      .file_from_bone.translation();
}

void check_frame(const Rigging& r) {
  const RigFrame& frame = r.rig.frame;
  if (frame.x.empty() == frame.radial.empty() || frame.y.empty() == frame.distal.empty()) {
    r.fail(
        "`frame` must give +X by either `x` (a file axis) or `radial` (two file bones), and +Y by "
        "either `y` (a file axis) or `distal` (a file bone)");
  }
  if (!frame.radial.empty() && frame.radial.size() != 2) {
    r.fail(fmt::format("`frame: radial` has {} entries instead of two bones", frame.radial.size()));
  }
}

Isometry3d file_from_hand(const Rigging& r) {
  const RigFrame& frame = r.rig.frame;
  const std::string& first = frame.origin.empty() ? r.rig.bones.front().joint : frame.origin;
  const Vector3d origin = joint_in_file(r, first, "origin");
  const Vector3d y = frame.distal.empty()
                         ? file_axis(r, frame.y, "y")
                         : Vector3d(joint_in_file(r, frame.distal, "distal") - origin);
  Vector3d x = frame.radial.empty() ? file_axis(r, frame.x, "x")
                                    : Vector3d(joint_in_file(r, frame.radial[1], "radial") -
                                               joint_in_file(r, frame.radial[0], "radial"));
  x -= x.dot(y) / y.squaredNorm() * y;
  if (!(x.norm() > kSameThing) || !(y.norm() > kSameThing)) {
    r.fail("`frame` gives no axes: its +X and +Y are parallel, or its bones are in one place");
  }
  Isometry3d transform = Isometry3d::Identity();
  transform.linear() << x.normalized(), y.normalized(), x.cross(y).normalized();
  transform.translation() = origin;
  return transform;
}

}  // namespace

void mirror_in_file(ImportedMesh& imported) {
  const Vector3d flip(-1, 1, 1);
  imported.mesh.vertices.row(0) *= -1;
  imported.mesh.triangles.row(1).swap(imported.mesh.triangles.row(2));
  if (imported.mesh.uv_triangles.cols() > 0) {
    imported.mesh.uv_triangles.row(1).swap(imported.mesh.uv_triangles.row(2));
  }
  for (ImportedBone& bone : imported.bones) {
    bone.file_from_bone.linear() =
        flip.asDiagonal() * bone.file_from_bone.linear() * flip.asDiagonal();
    bone.file_from_bone.translation() = flip.asDiagonal() * bone.file_from_bone.translation();
  }
}

void move_to_hand_frame(Rigging& r) {
  check_frame(r);
  r.hand_from_file = file_from_hand(r).inverse();
  r.in.mesh.vertices = r.hand_from_file.cast<float>() * r.in.mesh.vertices;
  for (ImportedBone& bone : r.in.bones)
    bone.file_from_bone = r.hand_from_file * bone.file_from_bone;
}

}  // namespace hypotrack
