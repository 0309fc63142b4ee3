#include "icp_pso.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/search.hpp"
#include "levenberg_marquardt/levenberg_marquardt.hpp"
#include "pso/pso.hpp"
#include "random_search/random_search.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

using test::RecordingCost;

/// Evaluates the start only, and the point halfway to the target if it may.
class Halfway final : public Optimizer {
 public:
  explicit Halfway(Eigen::VectorXd target) : target_(std::move(target)) {}
  std::int64_t default_evaluations() const override { return 2; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t) override {
    BestSoFar best;
    Eigen::MatrixXd points(region.start.size(), std::min<std::int64_t>(budget.evaluations, 2));
    points.col(0) = region.start;
    if (points.cols() == 2) points.col(1) = 0.5 * (region.start + target_);
    Eigen::VectorXd costs(points.cols());
    cost.evaluate(points, costs);
    best.update(points, costs);
    return best.result();
  }

 private:
  Eigen::VectorXd target_;
};

std::unique_ptr<Optimizer> least_squares() {
  return std::make_unique<LevenbergMarquardt>(LevenbergMarquardtParams{});
}

TEST(IcpPso, WithoutStepsItIsTheSwarmOfThatManyParticles) {
  const SearchRegion region = test::tracking_region(27);
  const auto problem = test::rosenbrock(region, test::hidden_target(region, 5));
  RecordingCost expected(27, problem), found(27, problem);
  PsoParams pso;
  pso.particles = 8;
  Pso(pso).minimize(expected, region, {64}, 7);
  IcpPsoParams params;
  params.particles = 8;
  params.local_evaluations = 1;
  IcpPso(params, std::make_unique<Halfway>(region.start)).minimize(found, region, {64}, 7);
  EXPECT_EQ(found.points, expected.points);
}

TEST(IcpPso, ParticlesGoOnFromWhereTheirStepsEnded) {
  const SearchRegion region = test::tracking_region(9);
  const Eigen::VectorXd target = test::hidden_target(region, 5);
  RecordingCost cost(9, test::sphere(region, target));
  IcpPsoParams params;
  params.particles = 1;
  params.local_evaluations = 2;
  IcpPso(params, std::make_unique<Halfway>(target)).minimize(cost, region, {8}, 1);
  // A lone particle at its own best has no velocity: only its steps move it.
  ASSERT_EQ(cost.points.size(), 8u);
  for (std::size_t i = 2; i < 8; i += 2) EXPECT_EQ(cost.points[i], cost.points[i - 1]);
}

TEST(IcpPso, SearchesOfAGenerationShareBatches) {
  const SearchRegion region = test::tracking_region(12);
  RecordingCost cost(12, test::rosenbrock(region, test::hidden_target(region, 3)));
  cost.linearizes = true;
  IcpPsoParams params;
  params.particles = 8;
  const OptimizerResult result = IcpPso(params, least_squares()).minimize(cost, region, {144}, 1);
  EXPECT_EQ(cost.batches.front(), 8);
  EXPECT_EQ(cost.points.front(), region.start);
  EXPECT_EQ(result.cost, *std::ranges::min_element(cost.costs));
  EXPECT_EQ(result.evaluations, static_cast<std::int64_t>(cost.points.size() + cost.blurs.size()));
  EXPECT_LE(result.evaluations, 144);
}

TEST(IcpPso, LeavesAnEvaluationForEveryJacobianAndStep) {
  const SearchRegion region = test::tracking_region(12);
  for (const bool linearizes : {true, false}) {
    RecordingCost cost(12, test::rosenbrock(region, test::hidden_target(region, 3)));
    cost.linearizes = linearizes;
    IcpPsoParams params;
    params.particles = 4;
    const std::int64_t budget = 4 * (1 + 2 * ((linearizes ? 1 : 12) + 3));
    IcpPso(params, least_squares()).minimize(cost, region, {budget}, 1);
    const auto jacobians = linearizes ? static_cast<std::int64_t>(cost.blurs.size())
                                      : std::ranges::count(cost.batches, 12);
    EXPECT_EQ(jacobians, 4 * 2);
  }
}

TEST(IcpPso, LeavesEvaluationsForJacobiansThatDrawNeighbours) {
  const SearchRegion region = test::tracking_region(12);
  RecordingCost cost(12, test::rosenbrock(region, test::hidden_target(region, 3)));
  cost.linearizes = cost.draws = true;
  IcpPsoParams params;
  params.particles = 4;
  const std::int64_t budget = 4 * (1 + 2 * (13 + 3));
  IcpPso(params, least_squares()).minimize(cost, region, {budget}, 1);
  EXPECT_EQ(std::ssize(cost.blurs), 4 * 2);
  EXPECT_LE(cost.evaluations(), budget);
}

TEST(IcpPso, NeedsWhatItsStepsNeed) {
  EXPECT_TRUE(IcpPso({}, least_squares()).requirements().least_squares);
  const auto random = [] { return std::make_unique<RandomSearch>(RandomSearchParams{}); };
  EXPECT_FALSE(IcpPso({}, random()).requirements().least_squares);
}

TEST(IcpPso, RefusesCoefficientsWithoutConstriction) {
  IcpPsoParams params;
  params.social = 1;
  EXPECT_THAT([&] { IcpPso(params, least_squares(), "s.yaml:3:1"); },
              ::testing::ThrowsMessage<ConfigError>(::testing::StartsWith("s.yaml:3:1: ")));
}

}  // namespace
}  // namespace hypotrack
