// The SIMD renderer against the plain one, on every instruction set of this machine.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "cost/draw/hypothesis_drawer.hpp"
#include "every_target.hpp"
#include "observations.hpp"
#include "reference_rasterizer.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

constexpr double kDepthTolerance = 1e-4;  // relative
// Pixels of a tile whose centre an outline passes so closely that rounding decides.
constexpr int kEdgePixels = 4;

// Pixels where the depth or the coverage of two renderings differ.
int count_differences(const DepthTile& tile, const Eigen::MatrixXd& reference) {
  int differences = 0;
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x) {
      const double drawn = tile.inverse_depth[y * tile.stride + x];
      const double expected = reference(y, x);
      if (std::abs(drawn - expected) > kDepthTolerance * expected) ++differences;
    }
  }
  return differences;
}

// Whatever lies outside the bounds is zero, up to the end of every row.
bool empty_outside_bounds(const DepthTile& tile) {
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.stride; ++x) {
      const bool within = x >= tile.x0 && x < tile.x1 && y >= tile.y0 && y < tile.y1;
      if (!within && tile.inverse_depth[y * tile.stride + x] != 0) return false;
    }
  }
  return true;
}

// All pixels of all tiles.
std::vector<float> pixels(std::span<const DepthTile> tiles) {
  std::vector<float> all;
  for (const DepthTile& tile : tiles) {
    for (int y = 0; y < tile.height; ++y) {
      const float* row = tile.inverse_depth + y * tile.stride;
      all.insert(all.end(), row, row + tile.width);
    }
  }
  return all;
}

std::vector<std::int64_t> targets_of_this_machine() {
  std::vector<std::int64_t> targets;
  for (std::int64_t left = hwy::SupportedTargets() & compiled_simd_targets(); left != 0;
       left &= left - 1) {
    targets.push_back(left & -left);
  }
  return targets;
}

void use_target(std::int64_t target) {  // 0: the best one
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// Another instruction set of this machine with a fused multiply-add; 0: there is none. Leaves the
// best one in use: only then are all of the machine's known.
std::int64_t other_that_fuses(std::int64_t target) {
  use_target(0);
  for (const std::int64_t other : targets_of_this_machine()) {
    if (other != target && test::fuses_products_and_sums(other)) return other;
  }
  return 0;
}

class Rasterizer : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override {
    use_target(GetParam());
    ASSERT_STREQ(simd_target(), hwy::TargetName(GetParam()));
  }
  void TearDown() override { use_target(0); }

  // Draws random states one after the other with one drawer, so that clearing is tested as well.
  void expect_reference(const Scene& scene, const Observation& observation, int states,
                        const Eigen::Vector3d& center = {0, 0, 0.5}, double radius = 0.05) {
    const ScenePlan plan(scene);
    const FrameProjection frame(observation);
    HypothesisDrawer drawer(plan), by_views(plan);
    drawer.prepare(frame);
    by_views.prepare(frame);
    std::mt19937_64 random(7);
    std::vector<int> covered(observation.views.size(), 0);
    for (int i = 0; i < states; ++i) {
      const Eigen::VectorXd state = test::random_state(scene, random, center, radius);
      const auto tiles = drawer.draw(test::values_of(state));
      ASSERT_EQ(tiles.size(), observation.views.size());
      EXPECT_EQ(pixels(by_views.draw_by_views(test::values_of(state))), pixels(tiles));
      for (std::size_t v = 0; v < tiles.size(); ++v) {
        const auto reference =
            test::reference_inverse_depth(scene, state, observation.views[v].camera);
        EXPECT_LE(count_differences(tiles[v], reference), kEdgePixels)
            << "state " << i << ", view " << v;
        EXPECT_TRUE(empty_outside_bounds(tiles[v])) << "state " << i << ", view " << v;
        covered[v] += static_cast<int>((reference.array() > 0).count());
      }
    }
    for (const int pixels : covered) EXPECT_GT(pixels, 100 * states);  // something was compared
  }
};

TEST_P(Rasterizer, AgreesWithThePlainOneInARectifiedPair) {
  const Scene scene = test::hand_scene();
  const Observation observation = test::rectified_pair(scene);
  ASSERT_TRUE(FrameProjection(observation).pair);
  expect_reference(scene, observation, 12);
}

TEST_P(Rasterizer, AgreesWithThePlainOneForAnyCameras) {
  const Scene scene = test::hand_scene();
  const Observation observation = test::general_pair(scene);
  ASSERT_FALSE(FrameProjection(observation).pair);
  expect_reference(scene, observation, 12);
}

TEST_P(Rasterizer, AgreesOnSeveralModelsThatHideEachOther) {
  const Scene scene = test::hand_and_box_scene();
  expect_reference(scene, test::rectified_pair(scene), 8);
  expect_reference(scene, test::general_pair(scene), 4);
}

TEST_P(Rasterizer, AgreesWhereModelsLeaveTheTile) {
  const Scene scene = test::hand_and_box_scene();
  expect_reference(scene, test::rectified_pair(scene), 12, {0, 0, 0.4}, 0.25);
}

TEST_P(Rasterizer, AgreesWhereModelsReachTheNearPlane) {
  const Scene scene = test::hand_scene();
  Observation observation = test::rectified_pair(scene);
  observation.views[1].camera.cx = 0;  // nothing to see there otherwise
  expect_reference(scene, observation, 12, {0, 0, 0.06}, 0.05);
}

TEST_P(Rasterizer, AgreesForOtherTileSizes) {
  const Scene scene = test::hand_scene();
  for (const int size : {16, 37, 300}) {
    const Observation observation = test::rectified_pair(scene, size);
    const ScenePlan plan(scene);
    const FrameProjection frame(observation);
    HypothesisDrawer drawer(plan);
    drawer.prepare(frame);
    std::mt19937_64 random(3);
    const Eigen::VectorXd state = test::random_state(scene, random);
    const auto tiles = drawer.draw(test::values_of(state));
    for (std::size_t v = 0; v < 2; ++v) {
      const auto reference =
          test::reference_inverse_depth(scene, state, observation.views[v].camera);
      EXPECT_LE(count_differences(tiles[v], reference), kEdgePixels * (1 + size / 128)) << size;
      EXPECT_TRUE(empty_outside_bounds(tiles[v])) << size;
    }
  }
}

TEST_P(Rasterizer, DrawsBothSidesOfAnOpenMesh) {
  ModelData sheet = test::make_test_box();
  sheet.mesh.triangles = Eigen::Matrix3Xi(sheet.mesh.triangles.middleCols(8, 2));  // z = -0.06
  const Scene scene({{"sheet", std::make_shared<const Model>(sheet)}});
  const ScenePlan plan(scene);
  const FrameProjection frame(test::rectified_pair(scene));
  HypothesisDrawer drawer(plan);
  drawer.prepare(frame);
  for (const double turn : {0.0, 1.0}) {  // the front, then the back
    Eigen::VectorXd state = scene.rest_state();
    state.segment<7>(0) << 0, 0, 0.5, 1 - turn, turn, 0, 0;
    const DepthTile tile = drawer.draw(test::values_of(state))[0];
    const double z = turn == 0 ? 0.44 : 0.56;
    EXPECT_NEAR(1 / tile.inverse_depth[80 * tile.stride + 64], z, 1e-5);
  }
}

TEST_P(Rasterizer, LeavesNoGapsBetweenTriangles) {
  // A large flat fan whose triangles meet in one pixel centre and along pixel rows and columns.
  ModelData fan;
  Mesh mesh;
  constexpr int kRim = 64;
  mesh.vertices = Eigen::Matrix3Xf::Zero(3, kRim + 1);
  mesh.triangles.resize(3, kRim);
  for (int i = 0; i < kRim; ++i) {
    const double angle = 2 * M_PI * i / kRim;
    mesh.vertices.col(i + 1) << static_cast<float>(0.1 * std::cos(angle)),
        static_cast<float>(0.1 * std::sin(angle)), 0;
    mesh.triangles.col(i) << 0, i + 1, (i + 1) % kRim + 1;
  }
  const Scene scene({{"fan", std::make_shared<const Model>(rigid_model(mesh))}});
  Observation observation = test::rectified_pair(scene);
  for (TileView& view : observation.views) view.camera.cx = view.camera.cy = 64;
  observation.views[1].camera.camera_from_world.translation().x() = -0.01;
  const ScenePlan plan(scene);
  const FrameProjection frame(observation);
  HypothesisDrawer drawer(plan);
  drawer.prepare(frame);
  Eigen::VectorXd state = scene.rest_state();
  state[2] = 0.5;
  for (const DepthTile& tile : drawer.draw(test::values_of(state))) {
    const double center_x = &tile == &drawer.draw(test::values_of(state))[0] ? 64 : 64 - 240 * 0.02;
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x) {
        if (std::hypot(x - center_x, y - 64.0) > 47) continue;  // the radius is 48 pixels
        EXPECT_NEAR(tile.inverse_depth[y * tile.stride + x], 2.0, 1e-5) << x << " " << y;
      }
    }
  }
}

TEST_P(Rasterizer, DrawsTheSameToTheLastBitWhereverThereIsAFusedMultiplyAdd) {
  if (!test::fuses_products_and_sums(GetParam())) GTEST_SKIP() << "there is none";
  const std::int64_t other = other_that_fuses(GetParam());
  if (other == 0) GTEST_SKIP() << "no other instruction set of this machine has one";
  use_target(GetParam());
  const Scene scene = test::hand_and_box_scene();
  std::mt19937_64 random(5);
  for (const Observation& observation : {test::rectified_pair(scene), test::general_pair(scene)}) {
    const ScenePlan plan(scene);
    const FrameProjection frame(observation);
    HypothesisDrawer drawer(plan);
    drawer.prepare(frame);
    for (int i = 0; i < 10; ++i) {
      const Eigen::VectorXd state = test::random_state(scene, random);
      const std::vector<float> here = pixels(drawer.draw(test::values_of(state)));
      use_target(other);
      const std::vector<float> there = pixels(drawer.draw(test::values_of(state)));
      use_target(GetParam());
      ASSERT_EQ(here, there) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryTarget, Rasterizer, testing::ValuesIn(targets_of_this_machine()),
                         [](const auto& test) { return hwy::TargetName(test.param); });

}  // namespace
}  // namespace hypotrack
