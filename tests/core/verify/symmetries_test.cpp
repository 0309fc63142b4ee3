#include <gtest/gtest.h>

#include "test_models.hpp"
#include "track/verify/surface_points.hpp"

namespace hypotrack {
namespace {

TEST(Symmetries, ABoxHasThreeHalfTurnsAndACubeAllTurns) {
  EXPECT_EQ(symmetries(test::make_test_box({0.1, 0.05, 0.03}).mesh).size(), 3u);
  EXPECT_EQ(symmetries(test::make_test_box({0.1, 0.05, 0.05}).mesh).size(), 7u);
  EXPECT_EQ(symmetries(test::make_test_box({0.05, 0.05, 0.05}).mesh).size(), 23u);
}

TEST(Symmetries, AHandHasNone) { EXPECT_TRUE(symmetries(test::make_test_hand().mesh).empty()); }

TEST(Symmetries, AMeshWithoutSurfaceHasNone) { EXPECT_TRUE(symmetries(Mesh{}).empty()); }

TEST(Symmetries, PutAMeshOntoItselfWhereverItIsInItsFile) {
  Mesh mesh = test::make_test_box({0.1, 0.05, 0.03}).mesh;
  const Eigen::Isometry3f placed = Eigen::Translation3f(0.2f, 0, -0.1f) *
                                   Eigen::AngleAxisf(0.4f, Eigen::Vector3f(1, 2, 2).normalized());
  mesh.vertices = placed * mesh.vertices;
  const auto found = symmetries(mesh);
  ASSERT_EQ(found.size(), 3u);
  for (const Eigen::Isometry3d& motion : found) {
    const Eigen::Matrix3Xf moved = motion.cast<float>() * mesh.vertices;
    for (const auto& corner : moved.colwise())
      EXPECT_LT((mesh.vertices.colwise() - corner).colwise().norm().minCoeff(), 0.003f);
  }
}

}  // namespace
}  // namespace hypotrack
