#include <gtest/gtest.h>

#include "device.hpp"
#include "evaluate/evaluator.hpp"
#include "made_up_frame.hpp"
#include "observations.hpp"
#include "stereo_color.hpp"
#include "test_models.hpp"

namespace hypotrack::stereo_color {
namespace {

constexpr int kHypotheses = 200;

Eigen::MatrixXd random_states(const Scene& scene) {
  std::mt19937_64 random(11);
  Eigen::MatrixXd states(scene.dimension(), kHypotheses);
  for (auto state : states.colwise()) {
    state = test::random_state(scene, random, {0, 0, 0.5}, 0.05);
    scene.normalize(state);
  }
  return states;
}

// A foreground of wide stripes.
cv::Mat1b striped_mask(int width, int height) {
  cv::Mat1b mask(height, width, uchar{255});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) mask(y, x) = (8 * (x + y) / width) % 3 == 0 ? 0 : 255;
  }
  return mask;
}

// The same waves in both views: colours that are near each other, though not equal.
Observation colored(Observation observation) {
  for (TileView& view : observation.views) {
    const int width = view.camera.width, height = view.camera.height;
    view.color = test::made_up_view({.width = width, .height = height}).color;
    view.mask = striped_mask(width, height);
  }
  return observation;
}

Eigen::VectorXd costs_on(Backend backend, const Scene& scene, const Observation& observation,
                         const Params& params, const Eigen::MatrixXd& states) {
  Evaluator evaluator(scene, {{1, std::make_shared<StereoColor>(params)}}, {.backend = backend});
  evaluator.prepare(observation);
  Eigen::VectorXd costs(states.cols());
  evaluator.evaluate(states, costs);
  return costs;
}

void expect_like_the_cpu(const Scene& scene, const Observation& observation, const Params& params) {
  const Eigen::MatrixXd states = random_states(scene);
  const Eigen::VectorXd cpu = costs_on(Backend::cpu, scene, observation, params, states);
  const Eigen::VectorXd gpu = costs_on(Backend::cuda, scene, observation, params, states);
  ASSERT_LT(cpu.maxCoeff(), 0);  // every hypothesis is seen
  const Eigen::ArrayXd difference = (gpu - cpu).array().abs() / -cpu.minCoeff();
  EXPECT_LT(difference.maxCoeff(), 1e-3);
  EXPECT_LT(difference.mean(), 5e-5);
  EXPECT_EQ(costs_on(Backend::cuda, scene, observation, params, states), gpu);
}

class StereoColorOnDevice : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }

  // One pixel whose lookup rounds to its neighbour may differ by all it can score. Large tiles, and
  // colours and a mask that say about the same there, keep that small beside the score.
  static void expect_like_the_cpu_everywhere(Params params) {
    params.beta = 2;  // the made-up views are not that alike
    const Scene hand = test::hand_scene(), both = test::hand_and_box_scene();
    expect_like_the_cpu(hand, colored(test::rectified_pair(hand, 256)), params);
    expect_like_the_cpu(both, colored(test::rectified_pair(both, 512)), params);
    expect_like_the_cpu(both, colored(test::general_pair(both, 256)), params);
  }
};

TEST_F(StereoColorOnDevice, ScoresAsTheCpuByDefault) { expect_like_the_cpu_everywhere({}); }

TEST_F(StereoColorOnDevice, ScoresAsTheCpuInEveryDirectionAndLookup) {
  for (const auto direction :
       {Direction::left_to_right, Direction::right_to_left, Direction::both}) {
    for (const auto lookup : {Lookup::nearest, Lookup::bilinear}) {
      Params params;
      params.direction = direction;
      params.lookup = lookup;
      expect_like_the_cpu_everywhere(params);
    }
  }
}

TEST_F(StereoColorOnDevice, ScoresAsTheCpuInEveryAggregation) {
  for (const auto aggregation : {Aggregation::sum, Aggregation::mean_seen,
                                 Aggregation::mean_rendered, Aggregation::sum_per_sqrt}) {
    for (const auto direction : {Direction::right_to_left, Direction::both}) {
      Params params;
      params.aggregation = aggregation;
      params.direction = direction;
      expect_like_the_cpu_everywhere(params);
    }
  }
}

TEST_F(StereoColorOnDevice, ScoresAsTheCpuInEveryColorSpace) {
  for (const auto space : {ColorSpace::lab, ColorSpace::hsv, ColorSpace::gray}) {
    Params params;
    params.color_space = space;
    expect_like_the_cpu_everywhere(params);
  }
}

TEST_F(StereoColorOnDevice, CostsNothingWhereNothingIsSeen) {
  const Scene scene = test::hand_scene();
  Eigen::MatrixXd states = random_states(scene).leftCols(2);
  states(2, 0) = -0.5;  // behind the cameras
  states(0, 1) = 30;    // beside the tiles
  for (const auto aggregation : {Aggregation::sum, Aggregation::mean_seen,
                                 Aggregation::mean_rendered, Aggregation::sum_per_sqrt}) {
    Params params;
    params.aggregation = aggregation;
    const Eigen::VectorXd costs =
        costs_on(Backend::cuda, scene, colored(test::rectified_pair(scene)), params, states);
    EXPECT_EQ(costs, Eigen::Vector2d::Zero());
  }
}

}  // namespace
}  // namespace hypotrack::stereo_color
