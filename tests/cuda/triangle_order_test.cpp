#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "cost/cuda/draw/device_scene.hpp"

namespace hypotrack::cuda {
namespace {

constexpr int kSide = 32;  // squares of two triangles

/// A square sheet and, a little below, the same turned over; the triangles in any order.
Mesh two_sheets() {
  Mesh mesh;
  constexpr int kPoints = kSide + 1;
  mesh.vertices.resize(3, 2 * kPoints * kPoints);
  mesh.triangles.resize(3, 4 * kSide * kSide);
  for (int i = 0; i < 2 * kPoints * kPoints; ++i) {
    const int p = i % (kPoints * kPoints);
    mesh.vertices.col(i) =
        Eigen::Vector3f(p % kPoints, p / kPoints, i < kPoints * kPoints ? 0.0f : 0.5f) * 0.01f;
  }
  std::vector<Eigen::Vector3i> triangles;
  for (int sheet = 0; sheet < 2; ++sheet) {
    for (int square = 0; square < kSide * kSide; ++square) {
      const int a = sheet * kPoints * kPoints + square / kSide * kPoints + square % kSide;
      const int b = a + 1, c = a + kPoints, d = c + 1;
      const bool up = sheet == 0;
      triangles.push_back(up ? Eigen::Vector3i(a, c, b) : Eigen::Vector3i(a, b, c));
      triangles.push_back(up ? Eigen::Vector3i(b, c, d) : Eigen::Vector3i(b, d, c));
    }
  }
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(1));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    mesh.triangles.col(static_cast<Eigen::Index>(i)) = triangles[i];
  }
  return mesh;
}

/// The mean extent in x and y of 32 triangles at a time, and how many of these are of both sheets.
struct Groups {
  float extent = 0;
  int mixed = 0;
};
Groups groups_of_a_warp(const Mesh& mesh, const std::vector<int>& order) {
  Groups groups;
  const std::size_t count = order.size() / 32;
  for (std::size_t g = 0; g < count; ++g) {
    Eigen::AlignedBox3f box;
    for (std::size_t i = 32 * g; i < 32 * (g + 1); ++i) {
      for (const int v : mesh.triangles.col(order[i])) box.extend(mesh.vertices.col(v));
    }
    groups.extent += box.sizes().head<2>().maxCoeff() / static_cast<float>(count);
    groups.mixed += box.sizes().z() > 0 ? 1 : 0;
  }
  return groups;
}

TEST(TriangleOrder, HasEveryTriangleOnce) {
  std::vector<int> order = order_by_place(two_sheets());
  std::sort(order.begin(), order.end());
  std::vector<int> all(order.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(all.size(), 4u * kSide * kSide);
  EXPECT_EQ(order, all);
}

TEST(TriangleOrder, KeepsAWarpsTrianglesTogetherAndOnOneSide) {
  const Mesh mesh = two_sheets();
  const Groups groups = groups_of_a_warp(mesh, order_by_place(mesh));
  EXPECT_LE(groups.extent, 0.01f * kSide / 3);
  EXPECT_EQ(groups.mixed, 0);
}

TEST(TriangleOrder, TakesMeshesWithoutExtentOrTriangles) {
  EXPECT_TRUE(order_by_place(Mesh()).empty());
  Mesh point;
  point.vertices = Eigen::Matrix3Xf::Zero(3, 3);
  point.triangles = Eigen::Vector3i(0, 1, 2);
  EXPECT_THAT(order_by_place(point), testing::ElementsAre(0));
}

}  // namespace
}  // namespace hypotrack::cuda
