// Garbage in: no crash, no undefined behaviour (run with the sanitizers), no poisoned state.
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

#include "cost/draw/hypothesis_drawer.hpp"
#include "observations.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

// Ordinary, large, tiny, special and arbitrary bits.
double garbage(std::mt19937_64& random) {
  constexpr double kSpecial[] = {0.0,
                                 -0.0,
                                 1e9,
                                 -1e9,
                                 1e300,
                                 -1e300,
                                 1e-300,
                                 5e-324,
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()};
  std::uniform_real_distribution<double> unit(-1, 1);
  switch (random() % 4) {
    case 0:
      return kSpecial[random() % std::size(kSpecial)];
    case 1:
      return std::bit_cast<double>(random());
    case 2:
      return std::pow(10.0, 7 * unit(random)) * (random() % 2 ? 1 : -1);
    default:
      return unit(random);
  }
}

class Garbage : public testing::TestWithParam<bool> {
 protected:
  Garbage()
      : scene_(test::hand_and_box_scene()),
        observation_(GetParam() ? test::rectified_pair(scene_) : test::general_pair(scene_)),
        plan_(scene_),
        frame_(observation_),
        drawer_(plan_) {
    drawer_.prepare(frame_);
  }

  std::vector<float> draw(const Eigen::VectorXd& state) {
    std::vector<float> all;
    for (const DepthTile& tile : drawer_.draw(test::values_of(state))) {
      EXPECT_TRUE(0 <= tile.x0 && tile.x0 <= tile.x1 && tile.x1 <= tile.width);
      EXPECT_TRUE(0 <= tile.y0 && tile.y0 <= tile.y1 && tile.y1 <= tile.height);
      all.insert(all.end(), tile.inverse_depth, tile.inverse_depth + tile.stride * tile.height);
    }
    return all;
  }

  Scene scene_;
  Observation observation_;
  ScenePlan plan_;
  FrameProjection frame_;
  HypothesisDrawer drawer_;
};

TEST_P(Garbage, GivesDepthsWithinBoundsAndLeavesNothingBehind) {
  std::mt19937_64 random(99);
  Eigen::VectorXd good = test::random_state(scene_, random);
  const std::vector<float> expected = draw(good);
  for (int i = 0; i < 400; ++i) {
    Eigen::VectorXd state = good;
    const auto damaged = 1 + random() % 34;
    for (std::size_t k = 0; k < damaged; ++k) {
      state[static_cast<Eigen::Index>(random() % 34)] = garbage(random);
    }
    scene_.normalize(state);
    for (const float w : draw(state)) {
      ASSERT_GE(w, 0.0f);
      ASSERT_LE(w, 1 / kNear * 1.0001f);
    }
  }
  EXPECT_EQ(draw(good), expected);
}

TEST_P(Garbage, PlainMotionThroughTheCameraIsDrawn) {
  Eigen::VectorXd state = scene_.rest_state();
  for (int i = -50; i <= 50; ++i) {
    state[2] = state[29] = i * 0.01;
    draw(state);
    state[0] = i * 1e7;
    draw(state);
    state[0] = 0;
  }
}

TEST_P(Garbage, AModelThatCannotBeDrawnDoesNotDisturbTheOther) {
  std::mt19937_64 random(5);
  Eigen::VectorXd state = test::random_state(scene_, random);
  state.segment<3>(27) << 5, 5, 5;  // the box out of sight
  const std::vector<float> hand = draw(state);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e7}) {
    state[28] = bad;
    EXPECT_EQ(draw(state), hand);
  }
}

INSTANTIATE_TEST_SUITE_P(Cameras, Garbage, testing::Bool(),
                         [](const auto& test) { return test.param ? "Rectified" : "General"; });

}  // namespace
}  // namespace hypotrack
