#include "model/import/weld.hpp"

#include <gmock/gmock.h>

#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

using ::testing::ElementsAre;

TEST(WeldPoints, MergesWithinAMillionthOfTheDiagonalAndKeepsTheFirst) {
  Eigen::Matrix3Xf points(3, 5);
  points.col(0) << 0, 0, 0;
  points.col(1) << 1, 0, 0;
  points.col(2) << 0.5e-6f, 0, 0;  // the diagonal is 1
  points.col(3) << 1e-5f, 0, 0;
  points.col(4) << 1, 0, 0;
  EXPECT_THAT(weld_points(points), ElementsAre(0, 1, 0, 3, 1));
}

TEST(WeldPoints, AgreesWithComparingAllPairs) {
  // Coordinates on a coarse lattice with jitter far below the tolerance or far above it.
  Eigen::Matrix3Xf points(3, 600);
  unsigned state = 7;
  const auto next = [&] { return state = state * 1664525u + 1013904223u; };
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      points(axis, i) = static_cast<float>(next() >> 30) - 1.5f + (next() >> 31 ? 2e-7f : 0.0f);
    }
  }
  const std::vector<int> same = weld_points(points);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Eigen::Index first = 0;
    while ((points.col(first) - points.col(i)).norm() > 2e-6f) ++first;
    EXPECT_EQ(same[static_cast<std::size_t>(i)], first);
  }
}

TEST(WeldPoints, SurvivesPointsInOnePlace) {
  EXPECT_THAT(weld_points(Eigen::Matrix3Xf::Ones(3, 3)), ElementsAre(0, 0, 0));
  EXPECT_TRUE(weld_points(Eigen::Matrix3Xf(3, 0)).empty());
}

TEST(WeldPoints, KeepsPointsApartThatOtherBonesHold) {
  Eigen::Matrix3Xf points = Eigen::Matrix3Xf::Zero(3, 6);
  points.col(5) << 1, 0, 0;
  // The order of influences and those of weight 0 do not count; what a bone holds in parts adds up.
  EXPECT_THAT(weld_points(points, {{{0, 0.5f}, {1, 0.5f}},
                                   {{0, 1}},
                                   {{1, 0.5f}, {0, 0.5f}, {2, 0}},
                                   {{0, 0.4f}, {0, 0.6f}},
                                   {{0, 0.5f}, {2, 0.5f}},
                                   {{0, 1}}}),
              ElementsAre(0, 1, 0, 1, 4, 5));
}

TEST(StrongestInfluences, KeepsFourAndSumsToOne) {
  const auto kept = strongest_influences(
      {{5, 0.1f}, {1, 0.2f}, {2, 0.15f}, {3, 0.25f}, {4, 0.05f}, {1, 0.2f}, {6, 0.05f}});
  ASSERT_EQ(kept.size(), 4u);
  EXPECT_EQ(kept[0].bone, 1);
  EXPECT_FLOAT_EQ(kept[0].weight, 0.4f / 0.9f);
  EXPECT_EQ(kept[3].bone, 5);
  float sum = 0;
  for (const auto& influence : kept) sum += influence.weight;
  EXPECT_FLOAT_EQ(sum, 1);
}

TEST(Weld, SeamsSplitTextureCoordinatesButNotTheSurface) {
  TemporaryDirectory folder;
  const auto path = write_file(folder.path() / "seam.obj",
                               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                               "vt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 0.5\nvt 0 1\nvt 0.2 0.2\n"
                               "f 1/1 2/2 3/3\nf 1/6 3/4 4/5\n");
  write_file(folder.path() / "t.ppm", "P6\n1 1\n255\nabc");
  const ImportedMesh imported = import_mesh(path, {.texture = folder.path() / "t.ppm"});
  EXPECT_EQ(imported.mesh.vertices.cols(), 4);
  EXPECT_EQ(imported.mesh.triangles.cols(), 2);
  EXPECT_EQ(imported.mesh.uv.cols(), 6);
  EXPECT_EQ(imported.mesh.uv_triangles.cols(), 2);
}

/// Returns glb({}) with a copy of the vertex at (0, 1, 0), which only the last triangle uses.
GlbContent with_copy(std::array<float, 4> weights_of_copy) {
  GlbContent content;
  content.positions.push_back(content.positions[2]);
  content.joints[2] = {0, 1, 0, 0};
  content.weights[2] = {1, 0, 0, 0};
  content.joints.push_back({0, 1, 0, 0});
  content.weights.push_back(weights_of_copy);
  content.indices[content.indices.size() - 2] = 4;
  return content;
}

TEST(Weld, CopiesWithWeightsThatDifferByRoundingAreOneVertexWithTheirMean) {
  TemporaryDirectory folder;
  const ImportedMesh imported =
      import_mesh(write_file(folder.path() / "a.glb", glb(with_copy({1 - 0.004f, 0.004f, 0, 0}))));
  ASSERT_EQ(imported.mesh.vertices.cols(), 4);
  for (Eigen::Index v = 0; v < 4; ++v) {
    EXPECT_FLOAT_EQ(imported.mesh.bone_weights.col(v).sum(), 1);
    if (imported.mesh.vertices.col(v).isApprox(Eigen::Vector3f(0, 1, 0))) {
      EXPECT_NEAR(imported.mesh.bone_weights(0, v), 0.998f, 1e-5f);
      EXPECT_NEAR(imported.mesh.bone_weights(1, v), 0.002f, 1e-5f);
    }
  }
}

TEST(Weld, RigidPartsThatTouchStayApart) {
  TemporaryDirectory folder;
  const ImportedMesh imported =
      import_mesh(write_file(folder.path() / "a.glb", glb(with_copy({0, 1, 0, 0}))));
  ASSERT_EQ(imported.mesh.vertices.cols(), 5);
  for (Eigen::Index v = 0; v < 5; ++v) EXPECT_EQ(imported.mesh.bone_weights(0, v) == 1, v != 3);
}

TEST(Weld, DegenerateTrianglesAndUnusedVerticesGoAway) {
  TemporaryDirectory folder;
  const auto path = write_file(folder.path() / "a.obj",
                               "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.5 0 0\n"
                               "f 2 3 4\nf 2 2 3\nf 2 5 3\n");
  const ImportedMesh imported = import_mesh(path);
  EXPECT_EQ(imported.mesh.triangles.cols(), 1);
  EXPECT_EQ(imported.mesh.vertices.cols(), 3);
  EXPECT_LE(imported.mesh.vertices.maxCoeff(), 1);
}

}  // namespace
}  // namespace hypotrack::test
