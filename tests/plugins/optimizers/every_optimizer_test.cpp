// What holds for every optimizer, for all algorithms of NLopt and for those made of others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "cma_es.hpp"
#include "differential_evolution.hpp"
#include "icp_pso.hpp"
#include "levenberg_marquardt/levenberg_marquardt.hpp"
#include "multi_start.hpp"
#include "nlopt_optimizer.hpp"
#include "pipeline.hpp"
#include "pso/pso.hpp"
#include "random_search/random_search.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Candidate {
  std::string name;
  /// Bounds on mean cost over seeds at 1,024 evaluations in 27 dimensions, where it is about 0.25
  /// at the start for the sphere, 5.4 for the ellipsoid and 25 for Rosenbrock's valley.
  double sphere = kInfinity;
  double ellipsoid = kInfinity;
  double rosenbrock = kInfinity;
};

std::unique_ptr<Optimizer> make(const std::string& name) {
  if (name == "pso") {
    PsoParams params;
    params.particles = 32;
    return std::make_unique<Pso>(params);
  }
  if (name == "pso_of_groups") {
    PsoParams params;
    params.particles = 32;
    params.start.group_share = 0.3;
    params.reset.every = 3;
    return std::make_unique<Pso>(params);
  }
  if (name == "differential_evolution" || name == "de_best_1_bin") {
    DifferentialEvolutionParams params;
    if (name == "de_best_1_bin") {
      params.variant = DifferentialVariant::best_1_bin;
      params.weight = 0.5;
    }
    return std::make_unique<DifferentialEvolution>(params);
  }
  if (name == "cma_es") return std::make_unique<CmaEs>(CmaEsParams{});
  if (name == "pipeline") {
    std::vector<PipelineStage> stages;
    stages.push_back({"pso", make("pso"), 0.5, 1});
    stages.push_back({"nlopt", make("SBPLX"), 0.5, 0.5});
    return std::make_unique<Pipeline>(std::move(stages), 1024);
  }
  if (name == "multi_start") return std::make_unique<MultiStart>(MultiStartParams{}, make("SBPLX"));
  if (name == "levenberg_marquardt") {
    return std::make_unique<LevenbergMarquardt>(LevenbergMarquardtParams{});
  }
  if (name == "icp_pso")
    return std::make_unique<IcpPso>(IcpPsoParams{}, make("levenberg_marquardt"));
  if (name == "random_search") return std::make_unique<RandomSearch>(RandomSearchParams{});
  NloptParams params;
  params.algorithm = name;
  return std::make_unique<Nlopt>(params);
}

class EveryOptimizer : public ::testing::TestWithParam<Candidate> {
 protected:
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed = 1) {
    return make(GetParam().name)->minimize(cost, region, budget, seed);
  }
};

void expect_contract(const test::RecordingCost& cost, const OptimizerResult& result,
                     const SearchRegion& region, std::int64_t budget) {
  ASSERT_FALSE(cost.points.empty());
  EXPECT_EQ(cost.points[0], region.start) << "the start is evaluated first";
  EXPECT_EQ(result.evaluations, static_cast<std::int64_t>(cost.points.size()));
  EXPECT_LE(result.evaluations, budget);
  for (const auto& point : cost.points) {
    ASSERT_TRUE((point.array() >= region.lower.array()).all() &&
                (point.array() <= region.upper.array()).all())
        << point.transpose();
  }
  const auto best = std::ranges::min_element(cost.costs);
  EXPECT_EQ(result.cost, *best);
  EXPECT_EQ(result.point, cost.points[best - cost.costs.begin()]);
}

TEST_P(EveryOptimizer, KeepsBudgetAndBoundsInOneAndManyDimensions) {
  for (const int dimension : {1, 2, 27, 54}) {
    const SearchRegion region = test::tracking_region(dimension);
    for (const std::int64_t budget : {1, 2, 7, 1024}) {
      SCOPED_TRACE(std::to_string(dimension) + " dimensions, " + std::to_string(budget));
      test::RecordingCost cost(dimension, test::ellipsoid(region, test::hidden_target(region, 5)));
      expect_contract(cost, minimize(cost, region, {budget}), region, budget);
    }
  }
}

TEST_P(EveryOptimizer, SameSeedSameAnswerAlsoInTheMiddleOfOtherSearches) {
  const SearchRegion region = test::tracking_region(27);
  const auto problem = test::rosenbrock(region, test::hidden_target(region, 5));
  test::RecordingCost first(27, problem);
  minimize(first, region, {400}, 77);
  test::RecordingCost other(27, problem);
  minimize(other, region, {333}, 78);
  test::RecordingCost second(27, problem);
  minimize(second, region, {400}, 77);
  EXPECT_EQ(first.points, second.points);
}

TEST_P(EveryOptimizer, BoundsHoldWhereTheOptimumLiesBeyondThem) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, region.start.array() + 3.0));
  expect_contract(cost, minimize(cost, region, {600}), region, 600);
}

TEST_P(EveryOptimizer, FixedDimensionsAreLeftAlone) {
  SearchRegion region = test::tracking_region(12);
  for (const int d : {0, 5, 11}) region.lower[d] = region.upper[d] = region.start[d];
  test::RecordingCost cost(12,
                           test::sphere(region, test::hidden_target(test::tracking_region(12), 5)));
  const OptimizerResult result = minimize(cost, region, {600});
  expect_contract(cost, result, region, 600);
  EXPECT_LT(result.cost, cost.costs[0]);

  region.lower = region.upper = region.start;
  test::RecordingCost fixed(12, [](const Eigen::VectorXd&) { return 3.0; });
  EXPECT_EQ(minimize(fixed, region, {50}).cost, 3.0);
}

TEST_P(EveryOptimizer, SearchesOnBesideInfeasibleRegions) {
  const SearchRegion region = test::tracking_region(10);
  const Eigen::VectorXd target = test::hidden_target(region, 5);
  const auto smooth = test::sphere(region, target);
  test::RecordingCost cost(10, [&](const Eigen::VectorXd& x) {
    return x[1] > region.start[1] + 0.3 * region.spread[1] ? kInfinity : smooth(x);
  });
  const OptimizerResult result = minimize(cost, region, {1024});
  expect_contract(cost, result, region, 1024);
  EXPECT_LT(result.cost, cost.costs[0]);
}

TEST_P(EveryOptimizer, ReturnsTheStartWhereEverythingIsInfeasible) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, [](const Eigen::VectorXd&) { return kInfinity; });
  const OptimizerResult result = minimize(cost, region, {300});
  EXPECT_EQ(result.point, region.start);
  EXPECT_EQ(result.cost, kInfinity);
  EXPECT_LE(result.evaluations, 300);
}

TEST_P(EveryOptimizer, LeavesAnInfeasibleStart) {
  const SearchRegion region = test::tracking_region(4);
  test::RecordingCost cost(4, [&](const Eigen::VectorXd& x) {
    return x[0] <= region.start[0] ? kInfinity : (x - region.start).squaredNorm();
  });
  const OptimizerResult result = minimize(cost, region, {500});
  EXPECT_TRUE(std::isfinite(result.cost));
}

TEST_P(EveryOptimizer, AFlatObjectiveIsNoErrorAndGivesTheStart) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, [](const Eigen::VectorXd&) { return 0.25; });
  const OptimizerResult result = minimize(cost, region, {700});
  expect_contract(cost, result, region, 700);
  EXPECT_EQ(result.point, region.start);
}

TEST_P(EveryOptimizer, ExceptionsOfTheCostPassThroughUnchanged) {
  struct Special : std::runtime_error {
    using std::runtime_error::runtime_error;
  };
  const SearchRegion region = test::tracking_region(27);
  for (const int when : {0, 1, 2, 40}) {
    int calls = 0;
    test::RecordingCost cost(27, [&](const Eigen::VectorXd& x) {
      if (calls++ == when) throw Special("a very particular problem");
      return x.squaredNorm();
    });
    EXPECT_THAT([&] { minimize(cost, region, {500}); },
                ::testing::ThrowsMessage<Special>("a very particular problem"));
    EXPECT_EQ(calls, when + 1) << "nothing is evaluated after an exception";
  }
}

double mean_cost(const std::string& name, auto problem) {
  constexpr int kSeeds = 3;
  const SearchRegion region = test::tracking_region(27);
  double sum = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    test::RecordingCost cost(27, problem(region, test::hidden_target(region, seed)));
    sum += make(name)->minimize(cost, region, {1024}, seed).cost;
  }
  return sum / kSeeds;
}

TEST_P(EveryOptimizer, ConvergesToItsStatedQuality) {
  const double sphere = mean_cost(GetParam().name, test::sphere);
  const double ellipsoid = mean_cost(GetParam().name, test::ellipsoid);
  const double rosenbrock = mean_cost(GetParam().name, test::rosenbrock);
  RecordProperty("sphere", std::to_string(sphere));
  RecordProperty("ellipsoid", std::to_string(ellipsoid));
  RecordProperty("rosenbrock", std::to_string(rosenbrock));
  EXPECT_LT(sphere, GetParam().sphere);
  EXPECT_LT(ellipsoid, GetParam().ellipsoid);
  EXPECT_LT(rosenbrock, GetParam().rosenbrock);
}

INSTANTIATE_TEST_SUITE_P(
    All, EveryOptimizer,
    ::testing::Values(
        Candidate{"pso", 0.02, 0.35, 13}, Candidate{"random_search", 0.25, 4, 95},
        Candidate{"pso_of_groups", 0.04, 0.5, 18}, Candidate{"de_best_1_bin", 0.09, 0.7, 35},
        Candidate{"differential_evolution", 0.09, 1.3, 35}, Candidate{"cma_es", 0.002, 0.2, 5},
        Candidate{"pipeline", 1e-4, 0.004, 5}, Candidate{"multi_start", 0.003, 0.2, 12},
        Candidate{"icp_pso", 1e-6, 1e-4, 3}, Candidate{"levenberg_marquardt", 1e-09, 1e-09, 0.02},
        Candidate{"SBPLX", 1e-06, 1e-05, 0.3}, Candidate{"NELDERMEAD", 0.03, 0.4, 6},
        Candidate{"COBYLA", 1e-06, 0.002, 0.02}, Candidate{"BOBYQA", 1e-09, 1e-06, 0.02},
        Candidate{"PRAXIS", 0.001, 0.001, 1}, Candidate{"LBFGS", 1e-9, 1e-6, 0.01},
        Candidate{"VAR1", 1e-9, 1e-4, 0.01}, Candidate{"VAR2", 1e-9, 1e-4, 0.01},
        Candidate{"TNEWTON", 1e-6, 0.8, 8}, Candidate{"TNEWTON_RESTART", 1e-6, 0.3, 6},
        Candidate{"TNEWTON_PRECOND", 1e-6, 0.9, 5},
        Candidate{"TNEWTON_PRECOND_RESTART", 1e-6, 0.4, 6}, Candidate{"SLSQP", 1e-9, 1e-6, 9},
        Candidate{"MMA", 1e-6, 2e-4, 4}, Candidate{"CCSAQ", 1e-6, 2e-4, 5},
        Candidate{"CRS2_LM", 0.08, 0.9, 25}, Candidate{"ESCH", 0.06, 0.9, 16},
        Candidate{"ISRES", 0.11, 1.6, 35}, Candidate{"DIRECT", 0.01, 0.15, 11},
        Candidate{"DIRECT_L", 0.04, 0.5, 12}, Candidate{"DIRECT_L_RAND", 0.006, 0.08, 7},
        Candidate{"ORIG_DIRECT_L", 0.04, 0.5, 12}, Candidate{"MLSL_LDS", 0.006, 0.08, 5}),
    [](const auto& each) { return each.param.name; });

class SeededOptimizer : public ::testing::TestWithParam<std::string> {};

TEST_P(SeededOptimizer, DifferentSeedsGiveDifferentSearches) {
  const SearchRegion region = test::tracking_region(27);
  const auto problem = test::sphere(region, test::hidden_target(region, 5));
  test::RecordingCost first(27, problem);
  make(GetParam())->minimize(first, region, {300}, 1);
  test::RecordingCost second(27, problem);
  make(GetParam())->minimize(second, region, {300}, 2);
  EXPECT_NE(first.points, second.points);
  test::RecordingCost high(27, problem);
  make(GetParam())->minimize(high, region, {300}, 1 + (std::uint64_t{1} << 40));
  EXPECT_NE(first.points, high.points) << "the seed's high word counts";
}

INSTANTIATE_TEST_SUITE_P(All, SeededOptimizer,
                         ::testing::Values("pso", "pso_of_groups", "random_search",
                                           "differential_evolution", "cma_es", "pipeline",
                                           "multi_start", "icp_pso", "CRS2_LM", "ESCH", "ISRES",
                                           "DIRECT_L_RAND"));

}  // namespace
}  // namespace hypotrack
