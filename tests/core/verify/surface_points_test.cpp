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

TEST(SurfacePoints, AreThoseOfTheirCornersAlone) {
  const Mesh mesh = test::make_test_ball(0.05f).mesh;
  const SurfacePoints points = spread_points(mesh, 20);
  SurfacePoints of_corners = points;
  const Mesh corners = take_corners(mesh, of_corners);
  EXPECT_LE(corners.vertices.cols(), 60);
  EXPECT_EQ(corners.bone_weights.cols(), corners.vertices.cols());
  EXPECT_EQ(corners.bone_indices.cols(), corners.vertices.cols());
  EXPECT_EQ(positions(of_corners, corners.vertices), positions(points, mesh.vertices));
}

TEST(SurfacePoints, HaveTheColoursOfTheTexture) {
  Mesh mesh = test::make_test_box({0.1, 0.1, 0.001}).mesh;
  const SurfacePoints points = spread_points(mesh, 100);
  EXPECT_TRUE(texture_colors(mesh, points, 0.001).empty()) << "without a texture";
  mesh.texture = cv::Mat3b(100, 100, cv::Vec3b(200, 100, 50));  // top of the texture: v = 1
  mesh.texture.rowRange(50, 100) = cv::Scalar(0, 0, 0);
  mesh.uv = ((mesh.vertices.topRows<2>().array() + 0.05f) / 0.1f).matrix();
  mesh.uv_triangles = mesh.triangles.cast<int>();
  const Eigen::Matrix3Xf at = positions(points, mesh.vertices);
  const std::vector<cv::Vec3f> colors = texture_colors(mesh, points, 0.001);
  ASSERT_EQ(std::ssize(colors), points.count());
  for (Eigen::Index i = 0; i < points.count(); ++i) {
    if (std::abs(at(1, i)) < 0.002f) continue;
    const cv::Vec3f expected = at(1, i) > 0 ? cv::Vec3f(200, 100, 50) : cv::Vec3f(0, 0, 0);
    EXPECT_LT(cv::norm(colors[static_cast<std::size_t>(i)] - expected), 1) << at.col(i).transpose();
  }
}

TEST(SurfacePoints, ShowTextureColoursAveragedOverASquare) {
  Mesh mesh = test::make_test_box({0.1, 0.1, 0.001}).mesh;
  const SurfacePoints points = spread_points(mesh, 100);
  mesh.texture = cv::Mat3b(100, 100, cv::Vec3b(0, 0, 0));
  for (int y = 0; y < 100; ++y)
    for (int x = y % 2; x < 100; x += 2) mesh.texture.at<cv::Vec3b>(y, x) = {200, 200, 200};
  mesh.uv = ((mesh.vertices.topRows<2>().array() + 0.05f) / 0.1f).matrix();
  mesh.uv_triangles = mesh.triangles.cast<int>();
  for (const cv::Vec3f& color : texture_colors(mesh, points, 0.01)) EXPECT_NEAR(color[0], 100, 25);
}

TEST(SurfacePoints, AMeshWithoutAreaHasNone) { EXPECT_EQ(spread_points(Mesh{}, 50).count(), 0); }

}  // namespace
}  // namespace hypotrack
