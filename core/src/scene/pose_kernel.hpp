#pragma once

#include "base/exported.hpp"
#include "hypotrack/skeleton_pose.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Writes the 3x4 matrix, row by row, from the bind pose to the first camera for every bone of one
/// model. The single-precision operations equal the GPU's (hypotrack/cuda/pose.cuh), so that
/// results are bit-identical wherever there is a fused multiply-add. `state` is the model's,
/// normalised; `first_from_world` is 3x4, row by row. `locals` is scratch for 12 numbers per bone.
void pose_skeleton(const SkeletonLayout& skeleton, const float* state,
                   const float* first_from_world, float* locals, float* first_from_bind);

}  // namespace internal
}  // namespace hypotrack
