#include <fmt/format.h>

#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/shape.hpp"

namespace hypotrack {

void stretch_bones(ModelData& data, std::span<const BoneStretch> stretches) {
  if (stretches.size() != data.bones.size()) {
    throw Error(fmt::format("stretch_bones: found {} entries, expected one for each of {} bones",
                            stretches.size(), data.bones.size()));
  }
  const std::vector<Eigen::Isometry3d> before = bind_transforms(data);
  for (Bone& bone : data.bones) {
    if (bone.parent < 0) continue;
    bone.parent_from_bone.translation() =
        stretches[static_cast<std::size_t>(bone.parent)](bone.parent_from_bone.translation());
  }
  const std::vector<Eigen::Isometry3d> after = bind_transforms(data);
  for (Mesh* mesh : {&data.mesh, &data.simplified})
    for (Eigen::Index v = 0; v < mesh->vertices.cols(); ++v) {
      const Eigen::Vector3d vertex = mesh->vertices.col(v).cast<double>();
      Eigen::Vector3d moved = Eigen::Vector3d::Zero();
      for (int k = 0; k < 4; ++k) {
        const double weight = static_cast<double>(mesh->bone_weights(k, v));
        if (weight == 0) continue;
        const auto bone = static_cast<std::size_t>(mesh->bone_indices(k, v));
        moved += weight * (after[bone] * stretches[bone](before[bone].inverse() * vertex));
      }
      mesh->vertices.col(v) = moved.cast<float>();
    }
  for (BoneMotion& motion : data.motions) {
    const Bone& bone = data.bones[static_cast<std::size_t>(motion.bone)];
    if (motion.kind != MotionKind::translation || bone.parent < 0) continue;
    const Eigen::Matrix3d& turn = bone.parent_from_bone.linear();
    const Eigen::Vector3d& factors = stretches[static_cast<std::size_t>(bone.parent)].factors;
    const Eigen::Vector3d axis = turn.transpose() * factors.cwiseProduct(turn * motion.axis);
    motion.scale *= axis.norm();
    motion.axis = axis.normalized();
  }
  for (Landmark& landmark : data.landmarks) {
    landmark.position = stretches[static_cast<std::size_t>(landmark.bone)](landmark.position);
  }
}

void scale_model(ModelData& data, double factor) {
  data.mesh.vertices *= static_cast<float>(factor);
  data.simplified.vertices *= static_cast<float>(factor);
  for (Bone& bone : data.bones) bone.parent_from_bone.translation() *= factor;
  for (BoneMotion& motion : data.motions) {
    if (motion.kind == MotionKind::translation) motion.scale *= factor;
  }
  for (Landmark& landmark : data.landmarks) landmark.position *= factor;
}

}  // namespace hypotrack
