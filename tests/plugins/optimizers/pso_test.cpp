#include "pso/pso.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/random.hpp"
#include "pso/swarm.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

SearchRegion line(double start, double lower, double upper, double spread) {
  return {Eigen::VectorXd::Constant(1, start), Eigen::VectorXd::Constant(1, lower),
          Eigen::VectorXd::Constant(1, upper), Eigen::VectorXd::Constant(1, spread)};
}

TEST(Pso, ConstrictionOfThePapersCoefficients) {
  // psi = 4.1: 2 / |2 - 4.1 - sqrt(4.1^2 - 4 * 4.1)| = 2 / (2.1 + sqrt(0.41))
  const Constriction constriction = make_constriction(2.8, 1.3, "pso");
  EXPECT_NEAR(constriction.factor, 0.729843788128, 1e-12);
  EXPECT_NEAR(constriction.velocity(0.5, 2.0, -1.0, 0.25, 0.5), 0.729843788128 * (0.5 + 1.4 - 0.65),
              1e-12);
}

TEST(Pso, CoefficientsThatDoNotConstrictAreRefused) {
  PsoParams params;
  params.cognitive = 2.0;
  params.social = 2.0;
  EXPECT_THAT([&] { Pso(params, "scene.yaml:7:3"); },
              ThrowsMessage<ConfigError>(
                  HasSubstr("scene.yaml:7:3: cognitive + social is 4.000000, expected above 4")));
}

TEST(Pso, TheDefaultBudgetIsParticlesTimesGenerations) {
  PsoParams params;
  params.particles = 32;
  params.generations = 20;
  EXPECT_EQ(Pso(params).default_evaluations(), 640);
}

TEST(Pso, AWholeGenerationIsOneBatchAndTheLastOneMayBePartial) {
  PsoParams params;
  params.particles = 16;
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, region.start));
  Pso(params).minimize(cost, region, {40}, 1);
  EXPECT_THAT(cost.batches, ElementsAre(16, 16, 8));
}

TEST(Pso, InitialParticlesAreNormalAboutTheStartWhichIsParticleZero) {
  PsoParams params;
  params.particles = 4000;
  const SearchRegion region = line(3, -100, 100, 2);
  test::RecordingCost cost(1, [](const Eigen::VectorXd&) { return 1.0; });
  Pso(params).minimize(cost, region, {4000}, 5);
  EXPECT_EQ(cost.points[0][0], 3);
  double sum = 0;
  double squares = 0;
  for (const auto& point : cost.points) {
    sum += point[0] - 3;
    squares += (point[0] - 3) * (point[0] - 3);
  }
  EXPECT_NEAR(sum / 4000, 0, 0.05);
  EXPECT_NEAR(std::sqrt(squares / 4000), 1.0, 0.05);  // sigma 0.5 times spread 2
}

// Two particles on a line, three generations, against the equations written out.
TEST(Pso, ParticlesMoveByClercAndKennedysEquations) {
  constexpr std::uint64_t kSeed = 42;
  const auto f = [](double x) { return (x - 4) * (x - 4); };
  PsoParams params;
  params.particles = 2;
  test::RecordingCost cost(1, [&](const Eigen::VectorXd& x) { return f(x[0]); });
  Pso(params).minimize(cost, line(3, -1000, 1000, 2), {6}, kSeed);

  const double k = 2 / std::abs(2 - 4.1 - std::sqrt(4.1 * 4.1 - 4 * 4.1));
  double x[2] = {3, 3 + 0.5 * 2 * normal(kSeed, {0, 1, 0, 1})};
  double v[2] = {0, 0};
  double own[2] = {x[0], x[1]};
  double swarm = f(x[1]) < f(x[0]) ? x[1] : x[0];
  for (std::uint32_t generation = 1; generation <= 2; ++generation) {
    for (std::uint32_t p = 0; p < 2; ++p) {
      const auto r = uniform4(kSeed, {0, p, generation, 0});
      v[p] = k * (v[p] + 2.8 * r[0] * (own[p] - x[p]) + 1.3 * r[1] * (swarm - x[p]));
      x[p] += v[p];
      EXPECT_NEAR(cost.points[2 * generation + p][0], x[p], 1e-12);
    }
    for (int p = 0; p < 2; ++p) {
      if (f(x[p]) < f(own[p])) own[p] = x[p];
      if (f(x[p]) < f(swarm)) swarm = x[p];
    }
  }
}

TEST(Pso, RandomNumbersAreDrawnPerDimension) {
  // Particle 0 starts at rest in its own best, so its first step is K c2 r2 (swarm's best - start).
  PsoParams params;
  params.particles = 20;
  const SearchRegion region{Eigen::Vector2d(0, 0), Eigen::Vector2d(-10, -10),
                            Eigen::Vector2d(10, 10), Eigen::Vector2d(1, 1)};
  const auto f = [](const Eigen::VectorXd& x) { return (x.array() - 5).square().sum(); };
  test::RecordingCost cost(2, f);
  Pso(params).minimize(cost, region, {21}, 3);
  const auto swarm_best =
      std::ranges::min_element(cost.points.begin(), cost.points.begin() + 20, {}, f);
  ASSERT_GT(swarm_best->cwiseAbs().minCoeff(), 0);
  const Eigen::VectorXd share = cost.points[20].cwiseQuotient(*swarm_best);
  EXPECT_GT(share.minCoeff(), 0);
  EXPECT_GT(std::abs(share[0] - share[1]), 1e-3);
}

TEST(Pso, TruncationStopsAParticleAtTheBound) {
  // The cost falls towards a bound that lies close: particles end on it and stay, they do not
  // leave.
  PsoParams params;
  params.particles = 8;
  const SearchRegion region = line(0, -1, 0.1, 1);
  test::RecordingCost cost(1, [](const Eigen::VectorXd& x) { return -x[0]; });
  const OptimizerResult result = Pso(params).minimize(cost, region, {80}, 9);
  EXPECT_EQ(result.point[0], 0.1);
  EXPECT_TRUE(std::ranges::all_of(cost.points, [](const auto& x) { return x[0] <= 0.1; }));
}

TEST(Pso, StopsBetweenGenerationsWhenTheTimeIsUp) {
  PsoParams params;
  params.particles = 10;
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, region.start));
  const OptimizerResult result = Pso(params).minimize(cost, region, {1000, 0.0}, 1);
  EXPECT_EQ(result.evaluations, 10);
}

}  // namespace
}  // namespace hypotrack
