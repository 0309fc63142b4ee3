#include <gmock/gmock.h>

#include <map>

#include "hypotrack/api/error.hpp"
#include "rigging.hpp"

namespace hypotrack::test {
namespace {

/// A closed square tube along y from 0 to 3, 2 wide, with texture coordinates.
Mesh tube() {
  Mesh mesh;
  mesh.vertices.resize(3, 16);
  for (int ring = 0; ring < 4; ++ring) {
    for (int k = 0; k < 4; ++k) {
      mesh.vertices.col(4 * ring + k) << (k == 0 || k == 3 ? -1.0f : 1.0f),
          static_cast<float>(ring), (k < 2 ? 1.0f : -1.0f);
    }
  }
  std::vector<Eigen::Vector3i> triangles = {{0, 2, 1}, {0, 3, 2}, {12, 13, 14}, {12, 14, 15}};
  for (int ring = 0; ring < 3; ++ring) {
    for (int k = 0; k < 4; ++k) {
      const int a = 4 * ring + k;
      const int b = 4 * ring + (k + 1) % 4;
      triangles.push_back({a, b, b + 4});
      triangles.push_back({a, b + 4, a + 4});
    }
  }
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
  }
  mesh.uv = mesh.vertices.topRows(2) / 4;
  mesh.uv_triangles = mesh.triangles;
  mesh.bone_indices.setZero(4, 16);
  mesh.bone_weights.setZero(4, 16);
  mesh.bone_weights.row(0).setOnes();
  return mesh;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Matrix3f corners = mesh.vertices(Eigen::all, mesh.triangles.col(t));
    sum += static_cast<double>(corners.determinant()) / 6;
  }
  return sum;
}

/// Every edge is used once in each direction.
bool watertight(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) ++edges[{mesh.triangles(k, t), mesh.triangles((k + 1) % 3, t)}];
  }
  for (const auto& [edge, count] : edges) {
    if (count != 1 || !edges.contains({edge.second, edge.first})) return false;
  }
  return true;
}

TEST(CutBelow, LeavesAClosedBodyOfTheRightVolume) {
  Mesh mesh = tube();
  ASSERT_TRUE(watertight(mesh));
  ASSERT_NEAR(volume(mesh), 12, 1e-5);
  cut_below(mesh, 0.75, "here");
  EXPECT_TRUE(watertight(mesh));
  EXPECT_NEAR(volume(mesh), 4 * 2.25, 1e-5);
  EXPECT_NEAR(mesh.vertices.row(1).minCoeff(), 0.75, 1e-6);
  EXPECT_EQ(mesh.uv_triangles.cols(), mesh.triangles.cols());
  EXPECT_LT(mesh.uv_triangles.maxCoeff(), mesh.uv.cols());
  EXPECT_TRUE(mesh.bone_weights.colwise().sum().isOnes());
}

TEST(CutBelow, LeavesAMeshAboveThePlaneAlone) {
  Mesh mesh = tube();
  cut_below(mesh, -1, "here");
  EXPECT_EQ(mesh.vertices.cols(), 16);
  EXPECT_EQ(mesh.triangles.cols(), tube().triangles.cols());
}

TEST(CutBelow, RefusesToCutEverything) {
  Mesh mesh = tube();
  try {
    cut_below(mesh, 4, "hand.yaml");
    FAIL() << "nothing is left of the mesh";
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("hand.yaml: cutting the arm"));
  }
}

}  // namespace
}  // namespace hypotrack::test
