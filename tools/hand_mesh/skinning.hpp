#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "anatomy.hpp"
#include "triangle_mesh.hpp"

namespace hypotrack::hand_mesh {

/// Up to four bones that move a vertex; unused slots have weight 0 and bone 0, weights sum to 1.
struct VertexWeights {
  std::array<int, 4> bones{};
  std::array<double, 4> weights{};
};

/// Weights for linear blend skinning at the bind pose. Along a digit they change over a short
/// stretch around each joint; across the palm they spread along the surface, so that one finger
/// never holds the skin of another.
std::vector<VertexWeights> skin_weights(const TriangleMesh& mesh,
                                        const std::vector<SkeletonBone>& skeleton);

/// The mesh's vertices with the bones at `hand_from_bone` (millimetres) instead of the bind pose.
std::vector<Eigen::Vector3d> skin(const TriangleMesh& mesh,
                                  const std::vector<VertexWeights>& weights,
                                  const std::vector<SkeletonBone>& skeleton,
                                  const std::vector<Eigen::Isometry3d>& hand_from_bone);

}  // namespace hypotrack::hand_mesh
