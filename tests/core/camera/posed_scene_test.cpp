#include "scene/posed_scene.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <random>

#include "every_target.hpp"
#include "hypotrack/api/error.hpp"
#include "scene/simd_kernels.hpp"
#include "test_cameras.hpp"
#include "test_models.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {
namespace {

Scene box_and_hand() {
  return Scene({{"box", std::make_shared<Model>(test::make_test_box())},
                {"hand", std::make_shared<Model>(test::make_test_hand())}});
}

/// Cameras side by side, turned against each other; two of them are rectified if `turn` is small.
std::vector<Camera> cameras(int lens, std::size_t count, double turn) {
  std::vector<Camera> out(count, test::lens_camera(lens));
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i);
    out[i].camera_from_world = test::pose({0, turn * x, 0.1}, {-0.08 * x, 0.002 * x, 0});
  }
  return out;
}

Frame black_frame(const std::vector<Camera>& cameras) {
  Frame frame;
  for (const Camera& camera : cameras)
    frame.views.push_back({cv::Mat::zeros(camera.height, camera.width, CV_8UC3), {}});
  return frame;
}

/// One vertex after the other.
Bounds plain_bounds(const PosedScene& posed, const Eigen::Isometry3d& ideal_from_first) {
  const Eigen::Matrix<float, 3, 4> m = ideal_from_first.matrix().topRows<3>().cast<float>();
  const ScenePoser& v = posed.vertices();
  Bounds bounds;
  for (const ScenePlan::Part& part : posed.plan().parts) {
    for (std::size_t i = part.first_vertex; i < part.first_vertex + part.vertex_count; ++i) {
      const auto along = [&](int row) {
        return m(row, 0) * v.x()[i] + m(row, 1) * v.y()[i] + m(row, 2) * v.z()[i] + m(row, 3);
      };
      const float z = along(2);
      bounds.x0 = std::min(bounds.x0, along(0) / z);
      bounds.x1 = std::max(bounds.x1, along(0) / z);
      bounds.y0 = std::min(bounds.y0, along(1) / z);
      bounds.y1 = std::max(bounds.y1, along(1) / z);
    }
  }
  return bounds;
}

TEST(PosedScene, BoundsWhatEveryCameraSees) {
  const Scene scene = box_and_hand();
  test::on_every_target(compiled_simd_targets(), [&] {
    std::mt19937_64 random(5);
    for (const std::size_t count : {1u, 2u, 3u}) {
      const IdealRig rig = make_ideal_rig(cameras(8, count, 0.1));
      PosedScene posed(scene, rig);
      for (int round = 0; round < 20; ++round) {
        posed.pose(test::random_state(scene, random, {0, 0, 0.6}, 0.1));
        ASSERT_TRUE(posed.in_front());
        ASSERT_EQ(posed.bounds().size(), count);
        for (std::size_t i = 0; i < count; ++i) {
          const Bounds expected =
              plain_bounds(posed, rig.ideal_from_world[i] * rig.ideal_from_world[0].inverse());
          const Bounds& found = posed.bounds()[i];
          EXPECT_FLOAT_EQ(found.x0, expected.x0);
          EXPECT_FLOAT_EQ(found.x1, expected.x1);
          EXPECT_FLOAT_EQ(found.y0, expected.y0);
          EXPECT_FLOAT_EQ(found.y1, expected.y1);
        }
      }
    }
  });
}

TEST(PosedScene, TilesAndSharesDependOnNoStateBefore) {
  const Scene scene = box_and_hand();
  std::mt19937_64 random(6);
  std::uniform_int_distribution<int> which(0, 4);
  int partly = 0, refused = 0;
  for (const double turn : {0.05, 0.7}) {
    const std::vector<Camera> rig = cameras(-4, 2, turn);
    const Frame frame = black_frame(rig);
    std::vector<Eigen::VectorXd> states;
    for (int i = 0; i < 4; ++i)
      states.push_back(test::random_state(scene, random, {0.15 * i, 0, 0.5}, 0.1));
    states.push_back(states[0]);
    states.back()[2] = -0.1;  // behind the cameras
    const TileMaker used(scene, rig, {});
    for (int i = 0; i < 60; ++i) {
      const Eigen::VectorXd& state = states[static_cast<std::size_t>(which(random))];
      const TileMaker fresh(scene, rig, {});
      if (i % 3 != 0) {
        const double share = fresh.visible_share(state);
        EXPECT_EQ(used.visible_share(state), share);
        partly += share > 0 && share < 1;
      }
      if (i % 3 == 1) continue;
      if (state[2] < 0) {
        EXPECT_THROW(used.plan(frame, state), DataError);
        ++refused;
        continue;
      }
      const TilePlan expected = fresh.plan(frame, state);
      const TilePlan found = used.plan(frame, state);
      EXPECT_EQ(found.header.start, state);
      for (std::size_t view = 0; view < 2; ++view) {
        const TileCamera& a = expected.header.views[view].camera;
        const TileCamera& b = found.header.views[view].camera;
        EXPECT_EQ(a.fx, b.fx);
        EXPECT_EQ(a.cx, b.cx);
        EXPECT_EQ(a.cy, b.cy);
        EXPECT_EQ(expected.views[view].touched, found.views[view].touched);
      }
    }
  }
  EXPECT_GT(partly, 10);
  EXPECT_GT(refused, 5);
}

TEST(PosedScene, RefusesWhatIsNotFiniteAndForgetsIt) {
  const Scene scene = box_and_hand();
  PosedScene posed(scene, make_ideal_rig(cameras(0, 2, 0.05)));
  Eigen::VectorXd state = scene.rest_state();
  for (const auto& item : scene.items()) state[item.offset + 2] = 0.5;
  posed.pose(state);
  EXPECT_NO_THROW(posed.check_in_front());
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e9, -0.5}) {
    Eigen::VectorXd broken = state;
    broken[2] = bad;
    posed.pose(broken);
    EXPECT_FALSE(posed.in_front()) << bad;
    EXPECT_THROW(posed.check_in_front(), DataError) << bad;
    posed.pose(state);
    EXPECT_TRUE(posed.in_front()) << bad;
  }
}

}  // namespace
}  // namespace hypotrack
