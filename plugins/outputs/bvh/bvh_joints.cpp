#include "bvh_joints.hpp"

#include <algorithm>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::bvh {
namespace {

/// Returns a name without the characters that end one in a BVH file.
std::string word(std::string name, const std::string& otherwise) {
  for (char& c : name)
    if ((c >= 0 && c <= ' ') || c == '{' || c == '}') c = '_';
  return name.empty() ? otherwise : name;
}

/// Returns the position of a bone's farthest landmark in the bone's frame; zero if it has none.
Eigen::Vector3d farthest_landmark(const ModelData& data, int bone) {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (const Landmark& landmark : data.landmarks)
    if (landmark.bone == bone && landmark.position.norm() > out.norm()) out = landmark.position;
  return out;
}

/// Returns whether the joints need a root above the bones.
bool has_several_roots(const ModelData& data) {
  return std::ranges::count(data.bones, -1, &Bone::parent) > 1;
}

}  // namespace

std::vector<Joint> joints_of(const Scene::Item& item) {
  const ModelData& data = item.model->data();
  const std::vector<Eigen::Isometry3d> bind = bind_transforms(data);
  const int above = has_several_roots(data) ? 1 : 0;
  std::vector<Joint> joints;
  if (above == 1) joints.push_back({.name = word(item.name, "root")});
  for (std::size_t i = 0; i < data.bones.size(); ++i) {
    const int parent = data.bones[i].parent;
    Joint joint{.name = word(data.bones[i].name, "bone_" + std::to_string(i)),
                .parent = parent < 0 ? above - 1 : parent + above};
    if (parent >= 0)
      joint.offset = bind[i].translation() - bind[static_cast<std::size_t>(parent)].translation();
    else if (above == 1)
      joint.offset = bind[i].translation();
    joint.model_from_bone = bind[i].linear();
    joint.end = bind[i].linear() * farthest_landmark(data, static_cast<int>(i));
    joint.slides = std::ranges::any_of(data.motions, [&](const BoneMotion& motion) {
      return motion.kind == MotionKind::translation && motion.bone == static_cast<int>(i);
    });
    // The positions of a sliding joint are whole, as Blender and assimp read them. Other programs,
    // such as three.js, add the offset.
    if (joint.slides) joint.offset.setZero();
    joints.push_back(std::move(joint));
  }
  return joints;
}

Pose pose_of(std::span<const Joint> joints, const Model& model,
             std::span<const double> parameters) {
  std::vector<Eigen::Isometry3d> world = world_from_bones(model.data(), parameters);
  if (world.size() < joints.size()) world.insert(world.begin(), world_from_model(parameters));
  const Eigen::Matrix3d turned = Eigen::Vector3d(1, -1, -1).asDiagonal();
  Pose pose;
  std::vector<Eigen::Matrix3d> file_from_joint;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    file_from_joint.push_back(turned * world[i].linear() * joints[i].model_from_bone.transpose());
    if (joints[i].parent < 0) {
      pose.positions.emplace_back(turned * world[i].translation());
      pose.rotations.push_back(file_from_joint[i]);
      continue;
    }
    const auto parent = static_cast<std::size_t>(joints[i].parent);
    const Eigen::Matrix3d parent_from_file = file_from_joint[parent].transpose();
    pose.positions.emplace_back(parent_from_file * turned *
                                (world[i].translation() - world[parent].translation()));
    pose.rotations.emplace_back(parent_from_file * file_from_joint[i]);
  }
  return pose;
}

}  // namespace hypotrack::bvh
