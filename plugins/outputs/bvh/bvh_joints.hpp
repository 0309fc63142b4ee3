#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/api/scene.hpp"

namespace hypotrack::bvh {

/// A joint of a BVH file. At rest all joints are turned as the root.
struct Joint {
  std::string name;
  int parent = -1;                                   ///< index of an earlier joint; -1: the root
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< from the parent at rest, metres; 0: slides
  Eigen::Vector3d end = Eigen::Vector3d::Zero();     ///< from here to the end site of a leaf
  Eigen::Matrix3d model_from_bone = Eigen::Matrix3d::Identity();  ///< rotation at the bind pose
  bool slides = false;  ///< a parameter moves it along an axis
};

/// Returns the joints of a model: its bones and, if several have no parent, a root of the model's
/// name above them. Names have no spaces or braces. The end of a leaf is its farthest landmark.
std::vector<Joint> joints_of(const Scene::Item& item);

/// Pose of the joints in one frame.
struct Pose {
  std::vector<Eigen::Vector3d> positions{};  ///< of each joint in its parent, metres
  std::vector<Eigen::Matrix3d> rotations{};  ///< of each joint in its parent
};

/// Returns the pose of a model's joints in the axes of BVH: x right, y up, z back. The world has y
/// down and z forward.
Pose pose_of(std::span<const Joint> joints, const Model& model, std::span<const double> parameters);

}  // namespace hypotrack::bvh
