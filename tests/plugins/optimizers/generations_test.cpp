// The algorithms of pagmo, evaluated in batches.
#include "generations.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pagmo/algorithms/de.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "cma_es.hpp"
#include "differential_evolution.hpp"
#include "hypotrack/plugin/start_points.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

using ::testing::ElementsAre;

/// A wide region whose offsets are the points themselves.
SearchRegion unit_region(int dimension) {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(dimension);
  return {0 * one, -1 * one, one, one};
}

double valley(const pagmo::vector_double& x) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (i + 1.0) * (x[i] - 0.3) * (x[i] - 0.3);
  return sum;
}

/// The valley as pagmo itself would evaluate it, one point after the other.
struct Valley {
  int dimension = 5;
  pagmo::vector_double fitness(const pagmo::vector_double& x) const { return {valley(x)}; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(static_cast<std::size_t>(dimension), -1.0),
            pagmo::vector_double(static_cast<std::size_t>(dimension), 1.0)};
  }
};

TEST(Generations, BatchesTakeTheWayOfPagmoItself) {
  const SearchRegion region = unit_region(5);
  test::RecordingCost cost(5, [](const Eigen::VectorXd& x) {
    return valley({x.begin(), x.end()});
  });
  const Eigen::MatrixXd first = StartPoints(region, {}, 9).points(0, 12);
  const pagmo::algorithm one(pagmo::de(1, 0.6, 0.9, 6, 0, 0, 42));
  const OptimizerResult batched =
      search_in_generations(one, {first, 12, 1}, cost, region, {12 * 21}, 9);
  EXPECT_EQ(cost.batches, std::vector<int>(21, 12));

  pagmo::population population(Valley{}, 0u, 1u);
  for (const auto& point : first.colwise()) {
    population.push_back(pagmo::vector_double(point.begin(), point.end()));
  }
  const auto evolved = pagmo::algorithm(pagmo::de(20, 0.6, 0.9, 6, 0, 0, 42)).evolve(population);
  EXPECT_EQ(batched.cost, evolved.champion_f()[0]);
  EXPECT_EQ(std::vector<double>(batched.point.begin(), batched.point.end()), evolved.champion_x());
}

TEST(Generations, TheLastBatchIsWhatTheBudgetLeaves) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost differential(27, test::sphere(region, test::hidden_target(region, 5)));
  EXPECT_EQ(DifferentialEvolution({}).minimize(differential, region, {80}, 1).evaluations, 80);
  EXPECT_THAT(differential.batches, ElementsAre(32, 32, 16));
  test::RecordingCost cma(27, test::sphere(region, test::hidden_target(region, 5)));
  EXPECT_EQ(CmaEs({}).minimize(cma, region, {40}, 1).evaluations, 40);
  EXPECT_THAT(cma.batches, ElementsAre(1, 16, 16, 7)) << "the start, then whole generations";
}

TEST(Generations, TheSearchStaysInTheBox) {
  const SearchRegion region = test::tracking_region(27);
  const auto far = test::sphere(region, region.start.array() + 5 * region.spread.array());
  DifferentialEvolutionParams params;
  params.box = 1;
  CmaEsParams cma_params;
  cma_params.box = 1;
  test::RecordingCost differential(27, far), cma(27, far);
  DifferentialEvolution(params).minimize(differential, region, {600}, 1);
  CmaEs(cma_params).minimize(cma, region, {600}, 1);
  for (const test::RecordingCost* cost : {&differential, &cma}) {
    double furthest = 0;
    for (const auto& point : cost->points) {
      furthest = std::max(
          furthest, (point - region.start).cwiseQuotient(region.spread).cwiseAbs().maxCoeff());
    }
    EXPECT_LE(furthest, 1 + 1e-9);
    EXPECT_GT(furthest, 0.99);
  }
}

TEST(Generations, ATimeBudgetEndsTheSearchBetweenGenerations) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, region.start));
  EXPECT_EQ(DifferentialEvolution({}).minimize(cost, region, {10000, 0.0}, 1).evaluations, 32);
}

}  // namespace
}  // namespace hypotrack
