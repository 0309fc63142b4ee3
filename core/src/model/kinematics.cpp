#include "hypotrack/plugin/kinematics.hpp"

#include <fmt/format.h>

#include "hypotrack/api/error.hpp"
#include "model/posing.hpp"

namespace hypotrack {
namespace {

using Bones = std::vector<Eigen::Isometry3d>;

void require_size(std::span<const double> parameters, std::size_t expected) {
  if (parameters.size() >= expected) return;
  throw DataError(fmt::format("pose of a model: found {} parameters, expected {}",
                              parameters.size(), expected));
}

// Returns parent_from_bone of every bone, with the parameters' motions applied.
Bones parent_from_bones(const ModelData& data, std::span<const double> parameters) {
  Bones bones;
  bones.reserve(data.bones.size());
  for (const Bone& bone : data.bones) bones.push_back(bone.parent_from_bone);
  for (const BoneMotion& motion : data.motions) {
    const double value = parameters[static_cast<std::size_t>(motion.parameter)];
    const double amount = motion.scale * (value - motion.zero);
    Eigen::Isometry3d& bone = bones[static_cast<std::size_t>(motion.bone)];
    if (motion.kind == MotionKind::translation) {
      bone.translate(amount * motion.axis);
    } else {
      bone.rotate(Eigen::AngleAxisd(amount, motion.axis));
    }
  }
  return bones;
}

// Composes transforms to the parent into transforms to `root`; parents come first.
void chain(const ModelData& data, const Eigen::Isometry3d& root, Bones& bones) {
  for (std::size_t i = 0; i < bones.size(); ++i) {
    const int parent = data.bones[i].parent;
    const auto& above = parent < 0 ? root : bones[static_cast<std::size_t>(parent)];
    bones[i] = above * bones[i];
  }
}

}  // namespace

Eigen::Isometry3d world_from_model(std::span<const double> parameters) {
  require_size(parameters, 7);
  Eigen::Vector4d wxyz(parameters[3], parameters[4], parameters[5], parameters[6]);
  if (wxyz.isZero(0)) wxyz = Eigen::Vector4d::UnitX();
  wxyz.stableNormalize();
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).toRotationMatrix();
  result.translation() << parameters[0], parameters[1], parameters[2];
  return result;
}

std::vector<Eigen::Isometry3d> bind_transforms(const ModelData& data) {
  Bones bones;
  bones.reserve(data.bones.size());
  for (const Bone& bone : data.bones) bones.push_back(bone.parent_from_bone);
  chain(data, Eigen::Isometry3d::Identity(), bones);
  return bones;
}

std::vector<Eigen::Isometry3d> world_from_bones(const ModelData& data,
                                                std::span<const double> parameters) {
  require_size(parameters, data.parameters.size());
  Bones bones = parent_from_bones(data, parameters);
  chain(data, world_from_model(parameters), bones);
  return bones;
}

}  // namespace hypotrack

namespace hypotrack::internal {

Eigen::Matrix3Xf skin(const ModelData& data, const Mesh& mesh,
                      std::span<const Eigen::Isometry3d> world_from_bone) {
  Bones world_from_bind = bind_transforms(data);
  for (std::size_t i = 0; i < world_from_bind.size(); ++i) {
    world_from_bind[i] = world_from_bone[i] * world_from_bind[i].inverse();
  }
  Eigen::Matrix3Xf posed(3, mesh.vertices.cols());
  for (Eigen::Index v = 0; v < posed.cols(); ++v) {
    const Eigen::Vector3d bind = mesh.vertices.col(v).cast<double>();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) {
      const double weight = mesh.bone_weights(k, v);
      const auto bone = static_cast<std::size_t>(mesh.bone_indices(k, v));
      if (weight != 0) sum += weight * (world_from_bind[bone] * bind);
    }
    posed.col(v) = sum.cast<float>();
  }
  return posed;
}

Eigen::Matrix3Xf posed_vertices(const Model& model, const Mesh& mesh,
                                std::span<const double> parameters) {
  if (model.poses_itself()) return hypotrack::posed_vertices(model, parameters);
  return skin(model.data(), mesh, world_from_bones(model.data(), parameters));
}

Eigen::Matrix3Xd place_landmarks(const ModelData& data,
                                 std::span<const Eigen::Isometry3d> world_from_bone) {
  Eigen::Matrix3Xd placed(3, static_cast<Eigen::Index>(data.landmarks.size()));
  for (Eigen::Index i = 0; i < placed.cols(); ++i) {
    const Landmark& landmark = data.landmarks[static_cast<std::size_t>(i)];
    placed.col(i) = world_from_bone[static_cast<std::size_t>(landmark.bone)] * landmark.position;
  }
  return placed;
}

}  // namespace hypotrack::internal

namespace hypotrack {

Eigen::Matrix3Xd posed_landmarks(const Model& model, std::span<const double> parameters) {
  if (!model.poses_itself()) {
    return place_landmarks(model.data(), world_from_bones(model.data(), parameters));
  }
  Eigen::Matrix3Xf vertices;
  Eigen::Matrix3Xd landmarks;
  model.pose(parameters, vertices, landmarks);
  return landmarks;
}

Eigen::Matrix3Xf posed_vertices(const Model& model, std::span<const double> parameters) {
  if (!model.poses_itself()) {
    return skin(model.data(), model.data().mesh, world_from_bones(model.data(), parameters));
  }
  Eigen::Matrix3Xf vertices;
  Eigen::Matrix3Xd landmarks;
  model.pose(parameters, vertices, landmarks);
  return vertices;
}

}  // namespace hypotrack
