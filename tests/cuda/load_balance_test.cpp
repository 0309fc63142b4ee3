#include "cost/cuda/tiles/load_balance.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "test_models.hpp"

namespace hypotrack::cuda {
namespace {

using Box = Eigen::Vector3d;

IdealRig one_camera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 500;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return make_ideal_rig(std::vector<Camera>{camera});
}

/// A tile in which something of 1 m, 1 m away, is so many pixels wide.
TileCamera tile_of(double focal_px) {
  TileCamera tile;
  tile.fx = tile.fy = focal_px;
  return tile;
}

/// Boxes, `narrow` above `wide`, of 0.1 m height each, 1 m in front of the camera.
BandEnds work_of_two_boxes(double narrow, double wide, double focal_px = 500) {
  const Scene scene(
      {{"above", std::make_shared<Model>(test::make_test_box(Box(narrow, 0.1, 0.01)))},
       {"below", std::make_shared<Model>(test::make_test_box(Box(wide, 0.1, 0.01)))}});
  Eigen::VectorXd state(14);
  state << 0, -0.05, 1, 1, 0, 0, 0, 0, 0.05, 1, 1, 0, 0, 0;
  const IdealRig rig = one_camera();
  PosedScene posed(scene, rig);
  posed.pose(state);
  return bands_of_equal_work(posed, tile_of(focal_px));
}

void expect_rises_from_0_to_1(const BandEnds& ends) {
  EXPECT_EQ(ends.front(), 0);
  EXPECT_EQ(ends.back(), 1);
  EXPECT_TRUE(std::ranges::is_sorted(ends));
}

TEST(WorkOfRows, IsSpreadEvenlyOverTheRowsOfTwoEqualHalves) {
  const BandEnds ends = work_of_two_boxes(0.1, 0.1);
  expect_rises_from_0_to_1(ends);
  EXPECT_NEAR(ends[kMostBands / 2], 0.5, 0.05);
}

TEST(WorkOfRows, IsWhereTheSurfaceIs) {
  const BandEnds ends = work_of_two_boxes(0.02, 0.1);
  expect_rises_from_0_to_1(ends);
  // A sixth of the surface and half of all rows lie above the middle: 1/6 + 1/4 of 3/2.
  EXPECT_GT(ends[kMostBands / 2], 0.6);
  EXPECT_LT(ends[kMostBands / 4], 0.5);
}

TEST(WorkOfRows, IsWhereTheTrianglesAreIfTheyHaveNextToNoPixels) {
  const BandEnds ends = work_of_two_boxes(0.02, 0.1, 1);
  expect_rises_from_0_to_1(ends);
  EXPECT_NEAR(ends[kMostBands / 2], 0.5, 0.05);
}

TEST(WorkOfRows, IsSpreadEvenlyWhereNothingIsInFrontOfTheCamera) {
  const Scene scene({{"box", std::make_shared<Model>(test::make_test_box(Box(0.1, 0.1, 0.1)))}});
  Eigen::VectorXd state(7);
  state << 0, 0, -1, 1, 0, 0, 0;
  const IdealRig rig = one_camera();
  PosedScene posed(scene, rig);
  posed.pose(state);
  EXPECT_EQ(bands_of_equal_work(posed, tile_of(500)), even_bands());
  expect_rises_from_0_to_1(even_bands());
}

}  // namespace
}  // namespace hypotrack::cuda
