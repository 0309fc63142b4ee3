#include <Eigen/Geometry>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
namespace {

const Eigen::DiagonalMatrix<double, 3> kMirror(-1, 1, 1);

Eigen::Isometry3d mirrored_transform(const Eigen::Isometry3d& transform) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = kMirror * transform.linear() * kMirror;
  result.translation() = kMirror * transform.translation();
  return result;
}

}  // namespace

ModelData mirrored(const ModelData& data) {
  ModelData result = data;
  for (Mesh* mesh : {&result.mesh, &result.simplified}) {
    mesh->vertices.row(0) *= -1;
    // Mirroring reverses the orientation; reversing the winding restores it.
    mesh->triangles.row(1).swap(mesh->triangles.row(2));
  }
  if (result.mesh.uv_triangles.cols() > 0) {
    result.mesh.uv_triangles.row(1).swap(result.mesh.uv_triangles.row(2));
  }
  for (Bone& bone : result.bones) bone.parent_from_bone = mirrored_transform(bone.parent_from_bone);
  // A rotation axis is a pseudovector: M R(a, t) M = R(-M a, t), so angles keep their sign.
  for (BoneMotion& motion : result.motions) {
    const double sign = motion.kind == MotionKind::rotation ? -1 : 1;
    motion.axis = sign * (kMirror * motion.axis);
  }
  for (Landmark& landmark : result.landmarks) landmark.position.x() *= -1;
  return result;
}

}  // namespace hypotrack
