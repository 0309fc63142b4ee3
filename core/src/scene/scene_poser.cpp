#include "scene/scene_poser.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::internal {
namespace {

// Largest parameter. Larger ones are meaningless and would overflow single precision later.
constexpr double kLargestParameter = 1e6;

bool drawable(std::span<const double> parameters) {
  return std::all_of(parameters.begin(), parameters.end(),
                     [](double p) { return std::abs(p) <= kLargestParameter; });  // NaN: false
}

AlignedFloats zeros(std::size_t count) {
  auto floats = hwy::AllocateAligned<float>(count);
  std::fill_n(floats.get(), count, 0.0f);
  return floats;
}

}  // namespace

ScenePoser::ScenePoser(const ScenePlan& plan)
    : plan_(&plan),
      matrices_(zeros(std::max<std::size_t>(12 * static_cast<std::size_t>(plan.bone_count), 1))),
      x_(zeros(plan.vertex_count)),
      y_(zeros(plan.vertex_count)),
      z_(zeros(plan.vertex_count)) {}

void ScenePoser::pose(std::span<const double> state, const Eigen::Isometry3d& camera_from_world) {
  for (const ScenePlan::Skinned& model : plan_->skinned) {
    const auto parameters = state.subspan(static_cast<std::size_t>(model.offset),
                                          static_cast<std::size_t>(model.dimension));
    float* matrices = matrices_.get() + 12 * static_cast<std::size_t>(model.first_bone);
    if (drawable(parameters)) {
      model.poser.pose(parameters, camera_from_world, bones_, matrices);
    } else {
      std::fill_n(matrices, 12 * model.poser.bones(), 0.0f);
    }
  }
  skin_blocks(plan_->blocks, matrices_.get(), x_.get(), y_.get(), z_.get());
  for (const ScenePlan::Posed& model : plan_->posed) {
    const auto parameters = state.subspan(static_cast<std::size_t>(model.offset),
                                          static_cast<std::size_t>(model.model->dimension()));
    pose_itself(model, parameters, camera_from_world.cast<float>());
  }
  fill_up_blocks();
}

void ScenePoser::pose_itself(const ScenePlan::Posed& posed, std::span<const double> parameters,
                             const Eigen::Isometry3f& camera_from_world) {
  const Eigen::Index count = posed.model->data().mesh.vertices.cols();
  if (!drawable(parameters)) {
    for (float* to : {x_.get(), y_.get(), z_.get()}) std::fill_n(to + posed.first_vertex, count, 0);
    return;
  }
  posed.model->pose(parameters, posed_vertices_, posed_landmarks_);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3f vertex = camera_from_world * posed_vertices_.col(i);
    const std::size_t at = posed.first_vertex + static_cast<std::size_t>(i);
    x_[at] = vertex.x();
    y_[at] = vertex.y();
    z_[at] = vertex.z();
  }
}

void ScenePoser::fill_up_blocks() {
  for (const ScenePlan::Part& part : plan_->parts) {
    const std::size_t end = std::size_t{part.first_vertex} + part.vertex_count;
    const std::size_t rest = (kBlock - end % kBlock) % kBlock;
    for (float* to : {x_.get(), y_.get(), z_.get()}) std::fill_n(to + end, rest, to[end - 1]);
  }
}

}  // namespace hypotrack::internal
