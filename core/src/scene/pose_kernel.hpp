#pragma once

#include "hypotrack/skeleton_pose.hpp"

namespace hypotrack {

/// Writes per bone of a skeleton of one model what takes the vertices of the bind pose to the first
/// camera, 3x4 row by row: the same operations in single precision as on the GPU
/// (hypotrack/cuda/pose.cuh), fused alike, and so the same to the last bit wherever there is a
/// fused multiply-add. `state` is the model's, normalised; `first_from_world` is 3x4 row by row,
/// `locals` room for 12 numbers per bone.
void pose_skeleton(const SkeletonLayout& skeleton, const float* state,
                   const float* first_from_world, float* locals, float* first_from_bind);

}  // namespace hypotrack
