#include "surface.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <opencv2/core.hpp>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "scene/mesh_topology.hpp"

namespace hypotrack::articulated {
namespace {

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& corners : mesh.triangles.colwise())
    sum += static_cast<double>(mesh.vertices(Eigen::all, corners).determinant()) / 6;
  return sum;
}

/// A mechanism of links that are all fixed to the first, 1 m apart along x.
Assembly row_of(std::size_t links) {
  Mechanism mechanism;
  for (std::size_t i = 0; i < links; ++i) {
    mechanism.links.push_back(std::to_string(i));
    if (i == 0) continue;
    Joint joint{.name = "joint_" + std::to_string(i)};
    joint.parent = std::to_string(i - 1);
    joint.child = std::to_string(i);
    joint.parent_from_child.translation().x() = 1;
    mechanism.joints.push_back(joint);
  }
  return assemble(mechanism, "row.urdf");
}

Mesh textured_box(const cv::Mat& picture) {
  Mesh mesh = box_mesh({0.1, 0.1, 0.1});
  mesh.texture = picture;
  return mesh;
}

/// The texture's colour at a corner of a triangle.
cv::Vec3b color_at(const Mesh& mesh, Eigen::Index triangle, int corner) {
  const Eigen::Vector2f uv = mesh.uv.col(mesh.uv_triangles(corner, triangle));
  const auto x = static_cast<int>(uv.x() * static_cast<float>(mesh.texture.cols));
  const auto y = static_cast<int>((1 - uv.y()) * static_cast<float>(mesh.texture.rows));
  return mesh.texture.at<cv::Vec3b>(y, x);
}

TEST(Primitives, AreClosedAndAsLargeAsTheySay) {
  const Mesh box = box_mesh({0.1, 0.2, 0.3}), cylinder = cylinder_mesh(0.1, 0.5);
  const Mesh sphere = sphere_mesh(0.2);
  for (const Mesh* mesh : {&box, &cylinder, &sphere}) {
    EXPECT_TRUE(is_closed_outwards(*mesh));
    EXPECT_EQ(mesh->uv_triangles.cols(), mesh->triangles.cols());
    EXPECT_GE(mesh->uv.minCoeff(), 0);
    EXPECT_LE(mesh->uv.maxCoeff(), 1);
    EXPECT_LT(mesh->uv_triangles.maxCoeff(), mesh->uv.cols());
  }
  EXPECT_NEAR(volume(box), 0.006, 1e-8);
  const double pi = std::numbers::pi;
  EXPECT_NEAR(volume(cylinder) / (pi * 0.01 * 0.5), 1, 0.01);
  EXPECT_NEAR(volume(sphere) / (4.0 / 3 * pi * 0.008), 1, 0.02);
}

TEST(Surface, PutsPartsWhereTheirLinksAre) {
  const Mesh joined =
      join({{box_mesh({0.1, 0.1, 0.1}), 0}, {sphere_mesh(0.05), 2}}, row_of(3), "row.urdf");
  EXPECT_EQ(joined.bone_indices.maxCoeff(), 0);
  EXPECT_EQ(joined.bone_weights.colwise().sum().minCoeff(), 1);
  EXPECT_NEAR(joined.vertices.row(0).minCoeff(), -0.05f, 1e-6f);
  EXPECT_NEAR(joined.vertices.row(0).maxCoeff(), 2.05f, 1e-6f);
  EXPECT_TRUE(joined.texture.empty()) << "all parts have one colour";
}

TEST(Surface, KeepsTheColoursAndPicturesOfItsParts) {
  cv::Mat picture(16, 24, CV_8UC3, cv::Scalar(10, 20, 30));
  picture.colRange(0, 12).setTo(cv::Scalar(200, 100, 50));
  Mesh red = box_mesh({0.1, 0.1, 0.1});
  red.color = {1, 0, 0};
  const Mesh joined =
      join({{textured_box(picture), 0}, {red, 1}, {textured_box(picture), 1}}, row_of(2), "row");
  const Mesh& own = textured_box(picture);
  for (Eigen::Index t = 0; t < 12; ++t) {
    for (int k = 0; k < 3; ++k) {
      const bool left = own.uv(0, own.uv_triangles(k, t)) < 0.5f;
      const cv::Vec3b expected = left ? cv::Vec3b(200, 100, 50) : cv::Vec3b(10, 20, 30);
      EXPECT_EQ(color_at(joined, t, k), expected) << t;
      EXPECT_EQ(color_at(joined, 12 + t, k), cv::Vec3b(0, 0, 255)) << t;
      EXPECT_EQ(color_at(joined, 24 + t, k), expected) << t;
    }
  }
  EXPECT_LT(joined.texture.total(), 2 * (16 + 8) * (24 + 8)) << "equal pictures share a place";
}

TEST(Surface, RefusesTexturesThatAreTooLargeTogether) {
  std::vector<Part> parts;
  for (int i = 0; i < 20; ++i)
    parts.push_back({textured_box(cv::Mat(2048, 2048, CV_8UC3, cv::Scalar::all(10 * i))), 0});
  EXPECT_THAT(test::message_of<DataError>([&] { join(parts, row_of(1), "row.urdf"); }),
              testing::AllOf(testing::HasSubstr("row.urdf: its textures need "),
                             testing::HasSubstr("make the pictures smaller")));
}

}  // namespace
}  // namespace hypotrack::articulated
