#pragma once

#include <Eigen/Core>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Distance within which vertices are one, as a part of the bounding box's diagonal. Exporters
/// split vertices along seams and round their copies at most in the last digits.
inline constexpr float kWeldTolerance = 1e-6f;

/// For every point (3xN, finite) the index of the point that stands for it: the first one of the
/// list within the tolerance, itself if there is none.
HYPOTRACK_API std::vector<int> weld_points(const Eigen::Matrix3Xf& points);

struct BoneWeight {
  int bone = 0;
  float weight = 0;
};

/// The four strongest influences, strongest first, made to sum to 1. Several entries of one bone
/// are added up first; the sum of all must be positive.
HYPOTRACK_API std::vector<BoneWeight> strongest_influences(std::vector<BoneWeight> influences);

}  // namespace hypotrack
