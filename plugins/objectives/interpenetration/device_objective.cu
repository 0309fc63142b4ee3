#include <algorithm>

#include "collision_term.hpp"
#include "hypotrack/gpu/state_objective.cuh"

namespace hypotrack::interpenetration {
namespace {

/// Uploads the plan to the GPU with the first frame.
class OnDevice final : public cuda::StateObjective<CollisionTerm> {
 public:
  explicit OnDevice(const CollisionTerm& host) : StateObjective(host), host_(host) {}

 private:
  CollisionTerm make_term(const cuda::DeviceObservation&, cuda::Stream) override {
    if (shapes_.data()) return term_on_device_;
    const SkeletonLayout& bones = host_.skeleton;
    int models = 0, motions = 0;
    for (int b = 0; b < bones.bone_count; ++b) {
      models = std::max(models, bones.bones[b].model + 1);
      motions = std::max(motions, bones.bones[b].first_motion + bones.bones[b].motion_count);
    }
    term_on_device_ = host_;
    term_on_device_.skeleton.level = upload(level_, bones.level, bones.bone_count);
    term_on_device_.skeleton.models = upload(models_, bones.models, models);
    term_on_device_.skeleton.bones = upload(bones_, bones.bones, bones.bone_count);
    term_on_device_.skeleton.motions = upload(motions_, bones.motions, motions);
    term_on_device_.shapes = upload(shapes_, host_.shapes, host_.shape_count);
    term_on_device_.pairs = upload(pairs_, host_.pairs, host_.pair_count);
    return term_on_device_;
  }

  template <class T>
  static const T* upload(cuda::DeviceBuffer<T>& buffer, const T* from, int count) {
    const auto size = static_cast<std::size_t>(count);
    buffer.reserve(size + 1);
    cuda::check(cudaMemcpy(buffer.data(), from, size * sizeof(T), cudaMemcpyHostToDevice),
                "uploading what may collide");
    return buffer.data();
  }

  CollisionTerm host_, term_on_device_{};
  cuda::DeviceBuffer<std::int32_t> level_;
  cuda::DeviceBuffer<cuda::ModelLayout> models_;
  cuda::DeviceBuffer<cuda::BoneLayout> bones_;
  cuda::DeviceBuffer<cuda::JointMotion> motions_;
  cuda::DeviceBuffer<Shape> shapes_;
  cuda::DeviceBuffer<Pair> pairs_;
};

}  // namespace

std::unique_ptr<cuda::DeviceObjective> on_device(const CollisionTerm& term) {
  return std::make_unique<OnDevice>(term);
}

const char* capabilities() { return "device residuals device_residuals"; }

}  // namespace hypotrack::interpenetration
