#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <vector>

#include "collision_shape.hpp"

namespace hypotrack::interpenetration {
namespace {

constexpr float kMillimetre = 1e-3f;

/// A shape in the world and the memory that its axes are in.
struct Placed {
  Placed(const Shape& shape, const Eigen::Isometry3d& world_from_bone) {
    Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(placement.m) =
        world_from_bone.matrix().topRows<3>().cast<float>();
    in_world = posed(shape, placement);
  }
  Placed(const Placed&) = delete;
  Placement placement;
  PosedShape in_world;
};

Shape capsule(const Eigen::Vector3f& half, float radius) {
  return {0, 0, {0, 0, 0}, {half.x(), half.y(), half.z()}, radius};
}
Shape box(const Eigen::Vector3f& half) {
  return {0, 1, {0, 0, 0}, {half.x(), half.y(), half.z()}, 0};
}

Eigen::Isometry3d at(double x, double y, double z,
                     const Eigen::Quaterniond& rotation = Eigen::Quaterniond::Identity()) {
  Eigen::Isometry3d out(rotation);
  out.translation() << x, y, z;
  return out;
}

Eigen::Isometry3d random_place(std::mt19937_64& random, double radius) {
  std::uniform_real_distribution<double> uniform(-radius, radius);
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return at(uniform(random), uniform(random), uniform(random), q.normalized());
}

/// Points of a capsule's segment in the world.
std::vector<Eigen::Vector3d> segment(const PosedShape& shape, int count) {
  std::vector<Eigen::Vector3d> points;
  const Eigen::Map<const Eigen::Vector3f> center(shape.center), half(shape.half);
  for (int i = 0; i <= count; ++i) {
    const float t = -1 + 2 * static_cast<float>(i) / static_cast<float>(count);
    points.push_back((center + t * half).cast<double>());
  }
  return points;
}

TEST(CapsulesDepth, IsTheRadiiMinusTheSegmentsDistance) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 50; ++round) {
    const Placed a(capsule({0.03f, 0.01f, 0}, 0.01f), random_place(random, 0.05));
    const Placed b(capsule({0, 0, round % 5 ? 0.02f : 0.0f}, 0.008f), random_place(random, 0.05));
    double nearest = 1;
    for (const auto& p : segment(a.in_world, 200)) {
      for (const auto& q : segment(b.in_world, 200)) nearest = std::min(nearest, (p - q).norm());
    }
    EXPECT_NEAR(capsules_depth(a.in_world, b.in_world), 0.018 - nearest, 3e-4);
    EXPECT_NEAR(capsules_depth(a.in_world, b.in_world), capsules_depth(b.in_world, a.in_world),
                1e-7);
  }
}

TEST(CapsulesDepth, OfParallelAndOfShortOnesIsRight) {
  const Placed a(capsule({0.03f, 0, 0}, 0.01f), at(0, 0, 0));
  const Placed beside(capsule({0.03f, 0, 0}, 0.01f), at(0.01, 0.015, 0));
  const Placed behind(capsule({0.03f, 0, 0}, 0.01f), at(0.07, 0, 0));
  const Placed ball(capsule({0, 0, 0}, 0.01f), at(0.045, 0, 0));
  EXPECT_NEAR(capsules_depth(a.in_world, beside.in_world), 0.005, 1e-6);
  EXPECT_NEAR(capsules_depth(a.in_world, behind.in_world), 0.01, 1e-6);
  EXPECT_NEAR(capsules_depth(a.in_world, ball.in_world), 0.005, 1e-6);
  EXPECT_NEAR(capsules_depth(ball.in_world, ball.in_world), 0.02, 1e-6);
}

TEST(CapsuleBoxDepth, IsTheRadiusMinusTheSegmentsDistanceFromTheSurface) {
  std::mt19937_64 random(2);
  const Eigen::Vector3f half(0.05f, 0.017f, 0.015f);
  for (int round = 0; round < 50; ++round) {
    const Placed a(capsule({0.03f, 0.01f, 0}, 0.01f), random_place(random, 0.06));
    const Placed b(box(half), random_place(random, 0.02));
    double nearest = 1;
    for (const auto& p : segment(a.in_world, 2000)) {
      const Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> m(b.placement.m);
      const Eigen::Vector3f in_box = m.leftCols<3>().transpose() * (p.cast<float>() - m.col(3));
      nearest = std::min<double>(nearest, box_distance(in_box.data(), half.data()));
    }
    EXPECT_NEAR(capsule_box_depth(a.in_world, b.in_world), 0.01 - nearest, 5e-5);
  }
}

TEST(BoxDistance, IsPositiveOutsideAndNegativeInside) {
  const float half[3] = {0.05f, 0.02f, 0.01f};
  const auto distance = [&](float x, float y, float z) {
    const float point[3] = {x, y, z};
    return box_distance(point, half);
  };
  EXPECT_FLOAT_EQ(distance(0, 0, 0), -0.01f);
  EXPECT_FLOAT_EQ(distance(0.048f, 0, 0), -0.002f);
  EXPECT_FLOAT_EQ(distance(0.06f, 0, 0), 0.01f);
  EXPECT_FLOAT_EQ(distance(0.053f, -0.024f, 0), 0.005f);
}

TEST(BoxesDepth, IsThatOfTheShallowestWayOut) {
  const Placed a(box({0.05f, 0.02f, 0.01f}), at(0, 0, 0));
  const Placed above(box({0.05f, 0.02f, 0.01f}), at(0.01, 0.005, 0.017));
  EXPECT_NEAR(boxes_depth(a.in_world, above.in_world), 0.003, 1e-6);
  const Placed far(box({0.05f, 0.02f, 0.01f}), at(0, 0, 0.1));
  EXPECT_NEAR(boxes_depth(a.in_world, far.in_world), -0.08, 1e-6);
}

TEST(BoxesDepth, OfCrossedEdgesIsAlongTheirNormal) {
  const double quarter = std::acos(0.0) / 2;
  const auto tilted = [&](const Eigen::Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(quarter, axis));
  };
  // Both stand on an edge, along x and along y, and face each other along z.
  const double to_edge = 0.02 * std::sqrt(2.0);
  const Placed a(box({0.02f, 0.02f, 0.02f}), at(0, 0, 0, tilted({1, 0, 0})));
  const Placed b(box({0.02f, 0.02f, 0.02f}), at(0, 0, 2 * to_edge - 0.004, tilted({0, 1, 0})));
  EXPECT_NEAR(boxes_depth(a.in_world, b.in_world), 0.004, 1e-6);
}

TEST(BoxesDepth, OfABoxInAnotherFrameIsTheSame) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 20; ++round) {
    const Eigen::Isometry3d first = random_place(random, 0.05), second = random_place(random, 0.05);
    const Eigen::Isometry3d moved = random_place(random, 0.5);
    const Shape one = box({0.05f, 0.02f, 0.01f}), other = box({0.03f, 0.03f, 0.02f});
    const Placed a(one, first), b(other, second), c(one, moved * first), d(other, moved * second);
    EXPECT_NEAR(boxes_depth(a.in_world, b.in_world), boxes_depth(c.in_world, d.in_world), 1e-6);
    EXPECT_NEAR(boxes_depth(a.in_world, b.in_world), boxes_depth(b.in_world, a.in_world), 1e-6);
  }
}

TEST(MayCollide, NeverMissesACollision) {
  std::mt19937_64 random(4);
  int collisions = 0;
  for (int round = 0; round < 200; ++round) {
    const Placed a(capsule({0.03f, 0.01f, 0}, 0.01f), random_place(random, 0.04));
    const Placed b(capsule({0, 0, 0.02f}, 0.008f), random_place(random, 0.04));
    const float depth = capsules_depth(a.in_world, b.in_world);
    collisions += depth > 3 * kMillimetre;
    if (depth > 3 * kMillimetre) {
      EXPECT_TRUE(may_collide(a.in_world, b.in_world, 3 * kMillimetre));
    }
  }
  EXPECT_GT(collisions, 10);
}

}  // namespace
}  // namespace hypotrack::interpenetration
