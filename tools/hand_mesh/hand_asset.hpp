#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "skin_texture.hpp"
#include "skinning.hpp"
#include "triangle_mesh.hpp"
#include "unwrap.hpp"

namespace hypotrack::hand_mesh {

/// The finished hand, millimetres, hand frame, bind pose.
struct HandAsset {
  TriangleMesh mesh;
  std::vector<SkeletonBone> skeleton;
  std::vector<VertexWeights> weights;
  TextureMap texture_map;
  SkinAttributes attributes;
  cv::Mat texture;
};

/// Makes the hand; the same every time on one machine. `texture_size` in texels.
HandAsset make_hand(int texture_size);

}  // namespace hypotrack::hand_mesh
