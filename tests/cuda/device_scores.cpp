#include "device_scores.hpp"

#include <gtest/gtest.h>

#include "made_up_frame.hpp"
#include "test_models.hpp"

namespace hypotrack::test {
namespace {

cv::Mat1b striped_mask(int width, int height) {
  cv::Mat1b mask(height, width, uchar{255});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) mask(y, x) = (8 * (x + y) / width) % 3 == 0 ? 0 : 255;
  }
  return mask;
}

}  // namespace

Eigen::MatrixXd scored_states(const Scene& scene) {
  constexpr int kHypotheses = 200;
  std::mt19937_64 random(11);
  Eigen::MatrixXd states(scene.dimension(), kHypotheses);
  for (auto state : states.colwise()) {
    state = random_state(scene, random, {0, 0, 0.5}, 0.05);
    scene.normalize(state);
  }
  return states;
}

Observation colored(Observation observation) {
  for (TileView& view : observation.views) {
    const int width = view.camera.width, height = view.camera.height;
    view.color = made_up_view({.width = width, .height = height}).color;
    view.mask = striped_mask(width, height);
  }
  return observation;
}

Eigen::VectorXd costs_on(Backend backend, const Scene& scene, const Observation& observation,
                         const MakeObjective& make, const Eigen::MatrixXd& states) {
  Evaluator evaluator(scene, {{1, make()}}, {.backend = backend});
  evaluator.prepare(observation);
  Eigen::VectorXd costs(states.cols());
  evaluator.evaluate(states, costs);
  return costs;
}

void expect_like_the_cpu(const Scene& scene, Observation observation, const MakeObjective& make,
                         double worst, double mean) {
  const Eigen::MatrixXd states = scored_states(scene);
  observation.start = states.col(0);
  const Eigen::VectorXd cpu = costs_on(Backend::cpu, scene, observation, make, states);
  const Eigen::VectorXd gpu = costs_on(Backend::cuda, scene, observation, make, states);
  const double largest = cpu.array().abs().maxCoeff();
  ASSERT_GT(cpu.array().abs().minCoeff(), 0);  // every hypothesis is seen
  const Eigen::ArrayXd difference = (gpu - cpu).array().abs() / largest;
  EXPECT_LT(difference.maxCoeff(), worst);
  EXPECT_LT(difference.mean(), mean);
  EXPECT_EQ(costs_on(Backend::cuda, scene, observation, make, states), gpu);
}

}  // namespace hypotrack::test
