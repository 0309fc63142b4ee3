#include "scene/mesh_topology.hpp"

#include <gtest/gtest.h>

#include "test_models.hpp"

namespace hypotrack {
namespace {

Mesh two_boxes(float second_winding) {
  const Mesh box = test::make_test_box().mesh;
  Mesh both = box;
  both.vertices.resize(3, 16);
  both.vertices << box.vertices, (box.vertices * 0.5f);
  both.triangles.resize(3, 24);
  both.triangles << box.triangles, (box.triangles.array() + 8).matrix();
  if (second_winding < 0) {
    both.triangles.block(1, 12, 1, 12).swap(both.triangles.block(2, 12, 1, 12));
  }
  return both;
}

TEST(IsClosedOutwards, HoldsForSolidModels) {
  EXPECT_TRUE(is_closed_outwards(test::make_test_box().mesh));
  EXPECT_TRUE(is_closed_outwards(test::make_test_hand().mesh));
  EXPECT_TRUE(is_closed_outwards(mirrored(test::make_test_hand()).mesh));
  EXPECT_TRUE(is_closed_outwards(two_boxes(1)));
}

TEST(IsClosedOutwards, FailsWhereAFaceIsMissing) {
  Mesh mesh = test::make_test_box().mesh;
  mesh.triangles.conservativeResize(3, 11);
  EXPECT_FALSE(is_closed_outwards(mesh));
}

TEST(IsClosedOutwards, FailsWhereOneFaceIsTurned) {
  Mesh mesh = test::make_test_box().mesh;
  std::swap(mesh.triangles(1, 4), mesh.triangles(2, 4));
  EXPECT_FALSE(is_closed_outwards(mesh));
}

TEST(IsClosedOutwards, FailsWhereEverythingIsTurned) {
  Mesh mesh = test::make_test_box().mesh;
  mesh.triangles.row(1).swap(mesh.triangles.row(2));
  EXPECT_FALSE(is_closed_outwards(mesh));
}

TEST(IsClosedOutwards, FailsForACavity) { EXPECT_FALSE(is_closed_outwards(two_boxes(-1))); }

TEST(IsClosedOutwards, FailsWhereAFaceIsDoubled) {
  Mesh mesh = test::make_test_box().mesh;
  mesh.triangles.conservativeResize(3, 13);
  mesh.triangles.col(12) = mesh.triangles.col(0);
  EXPECT_FALSE(is_closed_outwards(mesh));
}

}  // namespace
}  // namespace hypotrack
