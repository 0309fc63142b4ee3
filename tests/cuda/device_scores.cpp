#include "device_scores.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cost/linearize/difference_blocks.hpp"
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

Observation with_depth(Observation observation) {
  for (TileView& view : observation.views) {
    const int width = view.camera.width, height = view.camera.height;
    cv::Mat1f depth(height, width);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const float wave = std::sin(0.1f * static_cast<float>(x + 2 * y));
        const bool hole = (x / 7 + y / 5) % 6 == 0;
        depth(y, x) = hole ? 0 : 0.5f + 0.0002f * static_cast<float>(x - y) + 0.01f * wave;
      }
    }
    view.depth = depth;
  }
  return observation;
}

Eigen::VectorXd costs_on(Backend backend, const Scene& scene, const Observation& observation,
                         const MakeObjective& make, const Eigen::MatrixXd& states) {
  const auto cost = make_cost(scene, {{1, make()}}, {.backend = backend});
  cost->prepare(observation);
  Eigen::VectorXd costs(states.cols());
  cost->evaluate(states, costs);
  return costs;
}

Residuals residuals_of(Cost& cost, const Eigen::MatrixXd& states) {
  Residuals all;
  // What is not written stays NaN.
  all.values.setConstant(cost.least_squares()->count(), states.cols(), NAN);
  all.costs.resize(states.cols());
  cost.least_squares()->evaluate(states, all.values, all.costs);
  return all;
}

namespace {

NormalEquations on_device(Cost& cost, const Eigen::MatrixXd& states, const Eigen::VectorXd& scale) {
  const auto differences = cost.least_squares()->differences();
  const Eigen::Index count = scale.size();
  Eigen::VectorXd costs(count);
  differences->evaluate(states.leftCols(2), costs.head(2));
  differences->move_to(1);
  return differences->normal_equations(states.middleCols(2, count), scale, costs);
}

/// Those of residuals that came down.
void expect_normal_equations(Cost& cost, const Eigen::MatrixXd& states,
                             const Eigen::MatrixXf& residuals) {
  const Eigen::Index count = states.cols() - 2;
  Eigen::VectorXd scale = Eigen::VectorXd::LinSpaced(count, -2, 3);
  scale[count / 2] = 0;
  const NormalEquations expected =
      normal_equations(residuals.col(1), residuals.middleCols(2, count), scale);
  const NormalEquations found = on_device(cost, states, scale);
  EXPECT_LT((found.a - expected.a).norm(), 1e-5 * expected.a.norm());
  EXPECT_LT((found.g - expected.g).norm(), 1e-5 * expected.g.norm());
  EXPECT_EQ(found.a.col(count / 2), Eigen::VectorXd::Zero(count));
  const NormalEquations again = on_device(cost, states, scale);
  EXPECT_EQ(again.a, found.a);
  EXPECT_EQ(again.g, found.g);
}

}  // namespace

void expect_residuals_like_the_cpu(const Scene& scene, const Observation& observation,
                                   const std::vector<ObjectiveTerm>& cpu_terms,
                                   const std::vector<ObjectiveTerm>& gpu_terms,
                                   const Eigen::MatrixXd& states, double worst, double mean) {
  const auto cpu = make_cost(scene, cpu_terms, {.backend = Backend::cpu}, {.least_squares = true});
  const auto gpu = make_cost(scene, gpu_terms, {.backend = Backend::cuda}, {.least_squares = true});
  cpu->prepare(observation);
  gpu->prepare(observation);
  ASSERT_EQ(gpu->least_squares()->count(), cpu->least_squares()->count());
  const Residuals expected = residuals_of(*cpu, states), found = residuals_of(*gpu, states);
  const float largest = expected.values.cwiseAbs().maxCoeff();
  ASSERT_GT(largest, 0);
  ASSERT_TRUE(found.values.allFinite());
  const Eigen::VectorXd apart =
      (found.values - expected.values).cwiseAbs().cast<double>().colwise().mean() / largest;
  EXPECT_LT(apart.maxCoeff(), worst);
  EXPECT_LT(apart.mean(), mean);
  // Compiled with the residuals, the cost may be contracted otherwise.
  Eigen::VectorXd costs(states.cols());
  gpu->evaluate(states, costs);
  EXPECT_LT((found.costs - costs).cwiseAbs().maxCoeff(), 1e-6 * costs.cwiseAbs().maxCoeff());
  const Residuals again = residuals_of(*gpu, states);
  EXPECT_EQ(again.values, found.values);
  EXPECT_EQ(again.costs, found.costs);
  expect_normal_equations(*gpu, states, found.values);
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
  if (!make()->residual_term()) return;
  expect_residuals_like_the_cpu(scene, observation, {{1, make()}}, {{1, make()}},
                                states.leftCols(29), worst, mean);
}

}  // namespace hypotrack::test
