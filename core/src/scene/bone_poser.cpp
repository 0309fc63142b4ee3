#include "scene/bone_poser.hpp"

#include <algorithm>

#include "scene/simd_kernels.hpp"

namespace hypotrack::internal {

BonePoser::BonePoser(const ModelData& data) : skeleton_(data) {}

void BonePoser::pose(std::span<const double> parameters, const Eigen::Isometry3d& camera_from_world,
                     Workspace& workspace, float* camera_from_bind) const {
  const std::size_t locals = 12 * skeleton_.bones.size();
  workspace.resize(std::max(workspace.size(), locals + parameters.size()));
  float* state = workspace.data() + locals;
  std::ranges::transform(parameters, state, [](double p) { return static_cast<float>(p); });
  const Eigen::Matrix<float, 3, 4, Eigen::RowMajor> camera =
      camera_from_world.matrix().topRows<3>().cast<float>();
  pose_skeleton(skeleton_.layout(), state, camera.data(), workspace.data(), camera_from_bind);
}

}  // namespace hypotrack::internal
