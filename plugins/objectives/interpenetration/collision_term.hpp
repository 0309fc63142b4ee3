#pragma once

#include <cstdint>
#include <memory>

#include "collision_shape.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/gpu/skeleton.hpp"

namespace hypotrack::interpenetration {

/// Two shapes that may penetrate each other by `slack` metres. Capsules come before boxes.
struct Pair {
  std::int32_t first, second;
  float slack;
};

/// The shapes and pairs of a scene, in host or device memory.
struct CollisionTerm {
  SkeletonLayout skeleton;
  std::int32_t shape_count;
  std::int32_t pair_count;
  const Shape* shapes;
  const Pair* pairs;

  /// Returns the number of scratch floats of a team. The memory must be aligned to 8 bytes.
  HYPOTRACK_PIXEL int scratch_floats() const {
    return static_cast<int>((sizeof(Placement) * static_cast<unsigned>(skeleton.bone_count) +
                             sizeof(PosedShape) * static_cast<unsigned>(shape_count)) /
                            sizeof(float));
  }

  /// Poses all shapes in a team's scratch memory.
  template <class Team>
  HYPOTRACK_PIXEL const PosedShape* pose(const double* state, const Team& team,
                                         float* scratch) const {
    auto* bones = reinterpret_cast<Placement*>(scratch);
    auto* shapes_in_world = reinterpret_cast<PosedShape*>(bones + skeleton.bone_count);
    pose_bones(skeleton, state, team, bones);
    for (int i = team.rank(); i < shape_count; i += team.size()) {
      shapes_in_world[i] = posed(shapes[i], bones[shapes[i].bone]);
    }
    team.sync();
    return shapes_in_world;
  }

  /// Returns by how much a pair exceeds its slack, in millimetres; 0 if it does not.
  HYPOTRACK_PIXEL float excess(const PosedShape* in_world, const Pair& pair) const {
    const PosedShape &a = in_world[pair.first], &b = in_world[pair.second];
    if (!may_collide(a, b, pair.slack)) return 0;
    const bool is_box = shapes[pair.second].is_box;
    const float depth = !is_box                     ? capsules_depth(a, b)
                        : shapes[pair.first].is_box ? boxes_depth(a, b)
                                                    : capsule_box_depth(a, b);
    return 1e3f * pixel::max(depth - pair.slack, 0.0f);
  }

  HYPOTRACK_PIXEL std::int64_t residual_count() const { return pair_count; }

  /// Returns the sum of the squared excesses of all pairs, in mm^2. The excesses are the residuals.
  /// `state` must be normalised.
  template <class Team, class Put>
  HYPOTRACK_PIXEL double cost_and_residuals(const double* state, int /*dimension*/,
                                            const Team& team, float* scratch,
                                            const Put& put) const {
    const PosedShape* in_world = pose(state, team, scratch);
    double sum = 0;
    for (int i = team.rank(); i < pair_count; i += team.size()) {
      const float depth = excess(in_world, pairs[i]);
      put(i, depth);
      sum += static_cast<double>(depth) * depth;
    }
    return team.sum(sum);
  }
  template <class Team>
  HYPOTRACK_PIXEL double cost(const double* state, int dimension, const Team& team,
                              float* scratch) const {
    return cost_and_residuals(state, dimension, team, scratch, IgnoreResidual{});
  }
};

/// Makes the term on the GPU; null in a build without CUDA. The host memory of `term` must outlive
/// it.
std::unique_ptr<cuda::DeviceObjective> on_device(const CollisionTerm& term);

/// Returns the capabilities for `plugins info`; the GPU's only in a build with CUDA.
const char* capabilities();

}  // namespace hypotrack::interpenetration
