#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "collision_plan.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "make_model.hpp"

namespace hypotrack::interpenetration {
namespace {

double distance_from(const Eigen::Vector3d& point, const Shape& shape,
                     const Eigen::Isometry3d& bone) {
  const Eigen::Vector3d center =
      bone * Eigen::Map<const Eigen::Vector3f>(shape.center).cast<double>();
  const Eigen::Vector3d half =
      bone.linear() * Eigen::Map<const Eigen::Vector3f>(shape.half).cast<double>();
  const double t = half.squaredNorm() > 0
                       ? std::clamp((point - center).dot(half) / half.squaredNorm(), -1.0, 1.0)
                       : 0.0;
  return (point - center - t * half).norm() - shape.radius;
}

TEST(BoneShapes, OfABoxAreTheBox) {
  const std::vector<Shape> shapes =
      bone_shapes(make_model("{type: rigid_box, size_mm: [100, 34, 30]}\n")->data());
  ASSERT_EQ(shapes.size(), 1u);
  EXPECT_TRUE(shapes[0].is_box);
  EXPECT_NEAR(shapes[0].half[0], 0.050, 1e-6);
  EXPECT_NEAR(shapes[0].half[1], 0.017, 1e-6);
  EXPECT_NEAR(shapes[0].half[2], 0.015, 1e-6);
  for (const float c : shapes[0].center) EXPECT_NEAR(c, 0, 1e-6);
}

TEST(BoneShapes, OfAHandAreACapsulePerSegmentAndAFewForThePalm) {
  const auto hand = make_model("type: hand\n");
  const ModelData& data = hand->data();
  std::map<std::string, int> count;
  for (const Shape& shape : bone_shapes(data)) {
    EXPECT_FALSE(shape.is_box);
    ++count[data.bones[static_cast<std::size_t>(shape.bone)].name];
  }
  for (const char* finger : {"thumb", "index", "middle", "ring", "little"}) {
    for (const char* segment : {"_1", "_2", "_3"}) {
      EXPECT_EQ(count[std::string(finger) + segment], 1) << finger << segment;
    }
  }
}

/// Nowhere thicker than the hand by 2.5 mm, and as thick within 6 mm almost everywhere (not at the
/// cut through the wrist).
TEST(BoneShapes, FillTheHandWithoutStickingOut) {
  const auto hand = make_model("type: hand\n");
  const ModelData& data = hand->data();
  const auto bind = bind_transforms(data);
  const std::vector<Shape> shapes = bone_shapes(data);
  int near = 0;
  for (const auto& vertex : data.mesh.vertices.colwise()) {
    double nearest = 1;
    for (const Shape& shape : shapes) {
      const double distance =
          distance_from(vertex.cast<double>(), shape, bind[static_cast<std::size_t>(shape.bone)]);
      nearest = std::min(nearest, distance);
    }
    EXPECT_GT(nearest, -0.0025);
    near += nearest < 0.006;
  }
  EXPECT_GT(near, 0.9 * static_cast<double>(data.mesh.vertices.cols()));
}

/// Within a millimetre: in the flat of a palm many middle lines are equally good.
TEST(BoneShapes, OfAMirroredHandAreMirrored) {
  const auto right = make_model("type: hand\n"), left = make_model("type: mirrored_hand\n");
  const std::vector<Shape> a = bone_shapes(right->data()), b = bone_shapes(left->data());
  ASSERT_EQ(a.size(), b.size());
  const auto right_bones = bind_transforms(right->data()),
             left_bones = bind_transforms(left->data());
  const auto center = [](const Shape& shape, const std::vector<Eigen::Isometry3d>& bones) {
    return Eigen::Vector3d(bones[static_cast<std::size_t>(shape.bone)] *
                           Eigen::Map<const Eigen::Vector3f>(shape.center).cast<double>());
  };
  for (const Shape& shape : a) {
    const Eigen::Vector3d mirrored =
        center(shape, right_bones).cwiseProduct(Eigen::Vector3d(-1, 1, 1));
    const auto twin = std::ranges::find_if(b, [&](const Shape& other) {
      return other.bone == shape.bone && (center(other, left_bones) - mirrored).norm() < 1e-3;
    });
    ASSERT_NE(twin, b.end()) << right->data().bones[static_cast<std::size_t>(shape.bone)].name;
    EXPECT_NEAR(twin->radius, shape.radius, 1e-4);
  }
}

/// A closed cylinder about the y axis.
Mesh cylinder(float radius, float height) {
  constexpr int kSides = 32;
  Mesh mesh;
  mesh.vertices.resize(3, 2 * kSides + 2);
  mesh.triangles.resize(3, 4 * kSides);
  mesh.vertices.col(2 * kSides) << 0, -height / 2, 0;
  mesh.vertices.col(2 * kSides + 1) << 0, height / 2, 0;
  for (int i = 0; i < kSides; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / kSides;
    const float x = radius * std::cos(angle), z = radius * std::sin(angle);
    mesh.vertices.col(2 * i) << x, -height / 2, z;
    mesh.vertices.col(2 * i + 1) << x, height / 2, z;
    const int a0 = 2 * i, a1 = a0 + 1, b0 = 2 * ((i + 1) % kSides), b1 = b0 + 1;
    mesh.triangles.col(4 * i) << a0, a1, b0;
    mesh.triangles.col(4 * i + 1) << a1, b1, b0;
    mesh.triangles.col(4 * i + 2) << 2 * kSides, a0, b0;
    mesh.triangles.col(4 * i + 3) << 2 * kSides + 1, b1, a1;
  }
  return mesh;
}

TEST(BoneShapes, OfACanAreOneCapsuleAlongIt) {
  const std::vector<Shape> shapes = bone_shapes(rigid_model(cylinder(0.02f, 0.14f)));
  ASSERT_EQ(shapes.size(), 1u);
  const Shape& can = shapes[0];
  EXPECT_FALSE(can.is_box);
  EXPECT_NEAR(can.radius, 0.02, 2e-4);
  EXPECT_NEAR(std::abs(can.half[1]), 0.05, 0.005);
  EXPECT_LT(std::hypot(can.half[0], can.half[2]), 5e-4);
  for (const float c : can.center) EXPECT_NEAR(c, 0, 5e-4);
}

TEST(BoneShapes, OfASlabThatIsNoBoxAreCapsulesBesideEachOther) {
  Mesh mesh = cylinder(0.02f, 0.14f);
  mesh.vertices.row(0) *= 4;
  const std::vector<Shape> shapes = bone_shapes(rigid_model(mesh));
  EXPECT_GE(shapes.size(), 3u);
  for (const Shape& shape : shapes) EXPECT_LT(shape.radius, 0.0205f);
}

}  // namespace
}  // namespace hypotrack::interpenetration
