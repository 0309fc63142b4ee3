#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "hypotrack/model.hpp"

namespace hypotrack {

/// Forward kinematics of one model, prepared so that a hypothesis costs no allocation. The same
/// result as world_from_bones() up to rounding.
class BonePoser {
 public:
  /// Room for a pose; one per thread.
  using Workspace = std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>>;

  explicit BonePoser(const ModelData& data);

  int bones() const { return static_cast<int>(bones_.size()); }

  /// Writes one 3x4 row-major camera_from_bone per bone. `parameters` must be finite with a
  /// normalised quaternion.
  void pose(const double* parameters, const Eigen::Isometry3d& camera_from_world,
            Workspace& workspace, float* camera_from_bone) const;

 private:
  struct PlannedBone {
    int parent;
    Eigen::Matrix3d rotation;
    Eigen::Vector3d translation;
    std::vector<BoneRotation> rotations;  // in the order in which they apply
  };
  std::vector<PlannedBone> bones_;
};

}  // namespace hypotrack
