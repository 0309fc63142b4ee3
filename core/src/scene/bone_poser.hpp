#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/gpu/skeleton.hpp"
#include "hypotrack/plugin/model.hpp"
#include "scene/simd_kernels.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Forward kinematics of one model without allocation per hypothesis. It computes
/// world_from_bones() in single precision, by the same operations as the GPU.
class BonePoser {
 public:
  /// Scratch memory of a pose; one per thread.
  using Workspace = std::vector<float>;

  explicit BonePoser(const ModelData& data) : skeleton_(data) {}

  int bones() const { return static_cast<int>(skeleton_.bones.size()); }

  /// Writes the 3x4 matrix, row by row, from the bind pose to the camera for every bone.
  /// `parameters` must be finite, with a normalised quaternion.
  void pose(std::span<const double> parameters, const Eigen::Isometry3d& camera_from_world,
            Workspace& workspace, float* camera_from_bind) const {
    const std::size_t locals = 12 * skeleton_.bones.size();
    workspace.resize(std::max(workspace.size(), locals + parameters.size()));
    float* state = workspace.data() + locals;
    std::ranges::transform(parameters, state, [](double p) { return static_cast<float>(p); });
    const Eigen::Matrix<float, 3, 4, Eigen::RowMajor> camera =
        camera_from_world.matrix().topRows<3>().cast<float>();
    pose_skeleton(skeleton_.layout(), state, camera.data(), workspace.data(), camera_from_bind);
  }

 private:
  Skeleton skeleton_;
};

}  // namespace internal
}  // namespace hypotrack
