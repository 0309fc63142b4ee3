#include "evaluate/bone_poser.hpp"

namespace hypotrack {

BonePoser::BonePoser(const ModelData& data) {
  for (const Bone& bone : data.bones) {
    bones_.push_back(
        {bone.parent, bone.parent_from_bone.linear(), bone.parent_from_bone.translation(), {}});
  }
  for (const BoneRotation& rotation : data.rotations) {
    bones_[static_cast<std::size_t>(rotation.bone)].rotations.push_back(rotation);
  }
}

void BonePoser::pose(const double* parameters, const Eigen::Isometry3d& camera_from_world,
                     Workspace& workspace, float* camera_from_bone) const {
  Eigen::Isometry3d world_from_model = Eigen::Isometry3d::Identity();
  world_from_model.linear() =
      Eigen::Quaterniond(parameters[3], parameters[4], parameters[5], parameters[6])
          .toRotationMatrix();
  world_from_model.translation() << parameters[0], parameters[1], parameters[2];
  const Eigen::Isometry3d root = camera_from_world * world_from_model;

  if (workspace.size() < bones_.size()) workspace.resize(bones_.size());
  for (std::size_t i = 0; i < bones_.size(); ++i) {
    const PlannedBone& bone = bones_[i];
    const auto& parent = bone.parent < 0 ? root : workspace[static_cast<std::size_t>(bone.parent)];
    Eigen::Matrix3d rotation = parent.linear() * bone.rotation;
    for (const BoneRotation& turn : bone.rotations) {
      const double angle = turn.scale * (parameters[turn.parameter] - turn.zero);
      rotation *= Eigen::AngleAxisd(angle, turn.axis).toRotationMatrix();
    }
    workspace[i].linear() = rotation;
    workspace[i].translation() = parent.linear() * bone.translation + parent.translation();
    Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(camera_from_bone + 12 * i) =
        workspace[i].matrix().topRows<3>().cast<float>();
  }
}

}  // namespace hypotrack
