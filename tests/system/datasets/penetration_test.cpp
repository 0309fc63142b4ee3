#include "penetration.hpp"

#include <gtest/gtest.h>

#include "test_models.hpp"

namespace hypotrack::test {
namespace {

const Mesh& box() {
  static const Mesh mesh = make_test_box({0.06, 0.04, 0.12}).mesh;
  return mesh;
}

double penetration_of(const Eigen::Vector3f& point) {
  const Eigen::Matrix3Xf points = point;
  return penetration(points, box().vertices, box().triangles);
}

TEST(Penetration, IsTheWayOutOfABox) {
  EXPECT_NEAR(penetration_of({0, 0, 0}), 0.02, 1e-6);
  EXPECT_NEAR(penetration_of({0.027f, 0.01f, 0.05f}), 0.003, 1e-6);
  EXPECT_EQ(penetration_of({0.031f, 0, 0}), 0);
  EXPECT_EQ(penetration_of({0, 0, 0.5f}), 0);
}

TEST(Penetration, TakesTheDeepestPoint) {
  Eigen::Matrix3Xf points(3, 3);
  points << 0.029f, 0.5f, 0.025f,  //
      0, 0, 0,                     //
      0, 0, 0;
  EXPECT_NEAR(penetration(points, box().vertices, box().triangles), 0.005, 1e-6);
}

TEST(Penetration, WindsOnceAroundTheInsideAndByHalfBehindALid) {
  EXPECT_NEAR(winding_number({0.01f, 0, 0}, box().vertices, box().triangles), 1, 1e-5);
  EXPECT_NEAR(winding_number({0.05f, 0, 0}, box().vertices, box().triangles), 0, 1e-5);
  Eigen::Matrix3Xf lid(3, 4);
  lid << -1, 1, 1, -1, -1, -1, 1, 1, 0, 0, 0, 0;
  Eigen::Matrix3Xi triangles(3, 2);
  triangles << 0, 0, 1, 2, 2, 3;  // faces +z
  EXPECT_NEAR(winding_number({0, 0, -0.001f}, lid, triangles), 0.5, 0.01);
  EXPECT_NEAR(winding_number({0, 0, 0.001f}, lid, triangles), -0.5, 0.01);
}

TEST(Clearance, IsTheDistanceToFaceEdgeAndCorner) {
  const auto clearance_of = [](const Eigen::Vector3f& point) {
    const Eigen::Matrix3Xf points = point;
    return clearance(points, box().vertices, box().triangles);
  };
  EXPECT_NEAR(clearance_of({0.04f, 0, 0}), 0.01, 1e-6);
  EXPECT_NEAR(clearance_of({0.033f, 0.024f, 0}), 0.005, 1e-6);
  EXPECT_NEAR(clearance_of({0.032f, 0.023f, 0.066f}), 0.007, 1e-6);
}

}  // namespace
}  // namespace hypotrack::test
