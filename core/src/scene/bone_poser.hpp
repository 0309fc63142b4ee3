#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/model.hpp"
#include "hypotrack/skeleton.hpp"

namespace hypotrack {

/// Forward kinematics of one model, prepared so that a hypothesis costs no allocation: what
/// world_from_bones() says in single precision, by the same operations as on the GPU.
class HYPOTRACK_API BonePoser {
 public:
  /// Room for a pose; one per thread.
  using Workspace = std::vector<float>;

  explicit BonePoser(const ModelData& data);

  int bones() const { return static_cast<int>(skeleton_.bones.size()); }

  /// Writes per bone what takes the vertices of the bind pose to the camera, 3x4 row by row.
  /// `parameters` must be finite with a normalised quaternion.
  void pose(std::span<const double> parameters, const Eigen::Isometry3d& camera_from_world,
            Workspace& workspace, float* camera_from_bind) const;

 private:
  Skeleton skeleton_;
};

}  // namespace hypotrack
