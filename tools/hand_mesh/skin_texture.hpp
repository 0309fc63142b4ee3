#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "surface.hpp"
#include "triangle_mesh.hpp"
#include "unwrap.hpp"

namespace hypotrack::hand_mesh {

/// What varies slowly over the skin, per vertex.
struct SkinAttributes {
  std::vector<Eigen::Vector3d> normals;  ///< outward, of the smooth surface
  std::vector<double> palmar;    ///< 0 on the back of hand and digits .. 1 on the palmar side
  std::vector<double> openness;  ///< share of the surroundings that is free, 0 .. 1
};

SkinAttributes skin_attributes(const TriangleMesh& mesh, const HandSurface& surface,
                               const std::vector<VertexWeights>& weights);

/// Skin as an 8-bit BGR image of `size` x `size`: a function of the place on the hand, so that
/// seams of the texture map do not show. Texels around charts repeat the nearest skin.
cv::Mat skin_texture(const TriangleMesh& mesh, const SkinAttributes& attributes,
                     const TextureMap& map, const HandSurface& surface, int size);

}  // namespace hypotrack::hand_mesh
