#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Welding distance, as a share of the bounding box's diagonal. Exporters split vertices along
/// seams and round the copies at most in the last digits.
inline constexpr float kWeldTolerance = 1e-6f;

struct BoneWeight {
  int bone = 0;
  float weight = 0;
};

/// Most that the weights of two points may differ in sum to be equal: rounding to bytes.
inline constexpr float kEqualWeights = 0.01f;

/// Returns for every point (3xN, finite) the index of its representative: the first point within
/// the tolerance that the same bones hold by equal weights, or itself. `influences` has one list
/// per point; it is empty for a rigid mesh. Points that other bones hold come apart in other poses.
std::vector<int> weld_points(const Eigen::Matrix3Xf& points,
                             const std::vector<std::vector<BoneWeight>>& influences = {});

/// Returns the four strongest influences, strongest first, scaled to sum to 1. Adds up several
/// entries of one bone first. The sum of all must be positive.
std::vector<BoneWeight> strongest_influences(std::vector<BoneWeight> influences);

}  // namespace internal
}  // namespace hypotrack
