#pragma once

#include <Eigen/Core>
#include <vector>

#include "skinning.hpp"
#include "triangle_mesh.hpp"

namespace hypotrack::hand_mesh {

/// Texture coordinates with their own index triple per triangle; a vertex on a seam has several.
struct TextureMap {
  std::vector<Eigen::Vector2d> coordinates;  ///< in [0, 1], v downwards (first texture row is 0)
  std::vector<Triangle> triangles;           ///< indices into coordinates, parallel to the mesh's
  std::vector<int> vertex_of;                ///< the mesh vertex of every coordinate
  double millimetres = 0;                    ///< on the surface, across the whole texture
};

/// Cuts the hand into charts (palmar and dorsal halves of the palm and of every digit, the cut at
/// the wrist), flattens each as rigidly as possible and packs them into the unit square at one
/// scale, so that all skin has the same share of the texture. Throws std::runtime_error where a
/// chart is no disc or folds over.
TextureMap unwrap(const TriangleMesh& mesh, const std::vector<VertexWeights>& weights,
                  const std::vector<SkeletonBone>& skeleton);

/// The chart of every triangle, counted from 0.
std::vector<int> chart_labels(const TriangleMesh& mesh, const std::vector<VertexWeights>& weights,
                              const std::vector<SkeletonBone>& skeleton);

}  // namespace hypotrack::hand_mesh
