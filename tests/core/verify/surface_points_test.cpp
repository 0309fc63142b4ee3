#include "track/verify/surface_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test_models.hpp"

namespace hypotrack {
namespace {

TEST(SurfacePoints, LieOnTheSurfaceInProportionToArea) {
  const Eigen::Vector3d size(0.1, 0.04, 0.02);
  const Mesh mesh = test::make_test_box(size).mesh;
  const SurfacePoints points = spread_points(mesh, 600);
  ASSERT_EQ(points.count(), 600);
  const Eigen::Matrix3Xf at = positions(points, mesh.vertices);
  int of_large_faces = 0;
  for (const auto& p : at.colwise()) {
    const Eigen::Vector3d from_faces = p.cast<double>().cwiseAbs() - size / 2;
    EXPECT_NEAR(from_faces.maxCoeff(), 0, 1e-6);
    of_large_faces += std::abs(from_faces.z()) < 1e-6;
  }
  const double share = 0.1 * 0.04 / (0.1 * 0.04 + 0.1 * 0.02 + 0.04 * 0.02);
  EXPECT_NEAR(of_large_faces / 600.0, share, 0.02);
}

TEST(SurfacePoints, FollowTheVertices) {
  const Mesh mesh = test::make_test_box().mesh;
  const SurfacePoints points = spread_points(mesh, 50);
  Eigen::Matrix3Xf moved = mesh.vertices;
  moved.colwise() += Eigen::Vector3f(1, 2, 3);
  const Eigen::Matrix3Xf shift = positions(points, moved) - positions(points, mesh.vertices);
  EXPECT_TRUE(shift.isApprox(Eigen::Vector3f(1, 2, 3).replicate(1, 50), 1e-5f));
}

TEST(SurfacePoints, AMeshWithoutAreaHasNone) { EXPECT_EQ(spread_points(Mesh{}, 50).count(), 0); }

}  // namespace
}  // namespace hypotrack
