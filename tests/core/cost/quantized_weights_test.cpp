#include "scene/quantized_weights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "test_models.hpp"

namespace hypotrack {
namespace {

/// The weights of a mesh with one vertex.
QuantizedWeights weights_of(const Eigen::Vector4i& bones, const Eigen::Vector4f& weights) {
  Mesh mesh;
  mesh.vertices = Eigen::Matrix3Xf::Zero(3, 1);
  mesh.bone_indices = bones;
  mesh.bone_weights = weights;
  return quantize_weights(mesh, 0);
}

TEST(QuantizedWeights, AddUpToOneAndAreThoseOfTheMeshWithinAUnit) {
  const Mesh& mesh = test::make_test_hand().mesh;
  for (int v = 0; v < mesh.vertices.cols(); ++v) {
    const QuantizedWeights held = quantize_weights(mesh, v);
    EXPECT_EQ(std::accumulate(held.weight.begin(), held.weight.end(), 0), cuda::kUnitWeight);
    for (int k = 0; k < 4; ++k) {
      if (mesh.bone_weights(k, v) < 1e-4f) continue;
      const auto found = std::find(held.bone.begin(), held.bone.end(), mesh.bone_indices(k, v));
      ASSERT_NE(found, held.bone.end()) << v;
      const auto weight = held.weight[static_cast<std::size_t>(found - held.bone.begin())];
      EXPECT_NEAR(weight, mesh.bone_weights(k, v) * cuda::kUnitWeight, 2) << v;
    }
  }
}

TEST(QuantizedWeights, AreInTheOrderOfBonesWithUnusedOnesBehind) {
  const QuantizedWeights held = weights_of({7, 0, 3, 9}, {0.25f, 0, 0.5f, 0.25f});
  EXPECT_EQ(held.bone, (std::array<int, 4>{3, 7, 9, 0}));
  EXPECT_EQ(held.weight[0], cuda::kUnitWeight - 2 * held.weight[1]);
  EXPECT_EQ(held.weight[1], held.weight[2]);
  EXPECT_EQ(held.weight[3], 0);
}

TEST(QuantizedWeights, NameABoneOnce) {
  const QuantizedWeights held = weights_of({5, 2, 5, 2}, {0.25f, 0.25f, 0.25f, 0.25f});
  EXPECT_EQ(held.bone, (std::array<int, 4>{2, 5, 0, 0}));
  EXPECT_NEAR(held.weight[0], held.weight[1], 2);
  EXPECT_EQ(held.weight[0] + held.weight[1], cuda::kUnitWeight);
}

TEST(QuantizedWeights, GiveTheLargestWhatRoundingLeavesOver) {
  const QuantizedWeights up = weights_of({1, 2, 3, 4}, {1e-5f, 1 - 3e-5f, 1e-5f, 1e-5f});
  EXPECT_EQ(up.weight, (std::array<std::uint16_t, 4>{1, cuda::kUnitWeight - 3, 1, 1}));
  const QuantizedWeights down = weights_of({1, 2, 3, 4}, {7e-6f, 1 - 2.1e-5f, 7e-6f, 7e-6f});
  EXPECT_EQ(down.bone, (std::array<int, 4>{2, 0, 0, 0}));
  EXPECT_EQ(down.weight[0], cuda::kUnitWeight);
}

}  // namespace
}  // namespace hypotrack
