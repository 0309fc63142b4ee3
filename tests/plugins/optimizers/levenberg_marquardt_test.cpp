#include "levenberg_marquardt/levenberg_marquardt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "cost/linearize/difference_blocks.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/search.hpp"
#include "limb_search.hpp"
#include "multi_start.hpp"
#include "pipeline.hpp"
#include "random_search/random_search.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

using test::Problem;
using test::RecordingCost;

OptimizerResult minimize(RecordingCost& cost, const SearchRegion& region, std::int64_t budget,
                         const LevenbergMarquardtParams& params = {}) {
  return LevenbergMarquardt(params).minimize(cost, region, {budget}, 1);
}

TEST(NormalEquations, AreThoseOfTheDenseJacobian) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  for (const Eigen::Index rows : {1, 63, 64, 65, 500}) {
    Eigen::VectorXf r(rows);
    for (float& x : r) x = normal(random);
    Eigen::MatrixXf beside = r.replicate(1, 7);
    // Parameters that are felt everywhere, in a few rows, in one, and nowhere.
    for (Eigen::Index i = 0; i < rows; ++i) {
      beside(i, 0) += normal(random);
      if (i % 100 < 9) beside(i, 2) += normal(random);
      if (i == rows / 2) beside(i, 3) += 1;
      beside(i, 5) = std::numeric_limits<float>::infinity();  // its scale is 0
    }
    const Eigen::VectorXd scale = (Eigen::VectorXd(7) << 2, 1, -3, 0.5, 1, 0, 1).finished();
    Eigen::MatrixXd j = (beside.colwise() - r).cast<double>() * scale.asDiagonal();
    j.col(5).setZero();
    const NormalEquations sums = normal_equations(r, beside, scale);
    EXPECT_TRUE(sums.a.isApprox(j.transpose() * j, 1e-5)) << rows;
    EXPECT_TRUE(sums.g.isApprox(j.transpose() * r.cast<double>(), 1e-5)) << rows;
    EXPECT_EQ(sums.a.col(4), Eigen::VectorXd::Zero(7));
  }
}

TEST(LevenbergMarquardt, SolvesALinearProblemWithOneJacobian) {
  SearchRegion region = test::tracking_region(27);
  region.lower.setConstant(-3);
  region.upper.setConstant(3);
  // A step goes no farther than one spread in any number.
  const Eigen::VectorXd target = region.start + 0.9 * region.spread;
  RecordingCost cost(27, test::ellipsoid(region, target));
  LevenbergMarquardtParams params;
  params.damping = 1e-6;
  params.mean_share = 0;
  const OptimizerResult result = minimize(cost, region, 1 + 27 + 3, params);
  EXPECT_LT(result.cost, 1e-8 * cost.costs[0]);
}

TEST(LevenbergMarquardt, TakesOneEvaluationForAJacobianWhereTheCostLinearizes) {
  SearchRegion region = test::tracking_region(27);
  region.lower.setConstant(-3);
  region.upper.setConstant(3);
  RecordingCost cost(27, test::ellipsoid(region, region.start + 0.9 * region.spread));
  cost.linearizes = true;
  LevenbergMarquardtParams params;
  params.damping = 1e-6;
  params.mean_share = 0;
  const OptimizerResult result = minimize(cost, region, 1 + 1 + 3, params);
  EXPECT_LT(result.cost, 1e-8 * cost.costs[0]);
  EXPECT_EQ(result.evaluations, 5);
  EXPECT_THAT(cost.batches, ::testing::ElementsAre(1, 3));
  EXPECT_THAT(cost.blurs, ::testing::ElementsAre(params.blur));
}

TEST(LevenbergMarquardt, CountsTheNeighboursThatAJacobianTakes) {
  const SearchRegion region = test::tracking_region(9);
  for (const std::int64_t budget : {1, 5, 12, 13, 40, 200}) {
    RecordingCost cost(9, test::rosenbrock(region, test::hidden_target(region, 3)));
    cost.linearizes = cost.draws = true;
    const OptimizerResult result = minimize(cost, region, budget);
    EXPECT_EQ(result.evaluations, cost.evaluations());
    EXPECT_LE(result.evaluations, budget);
    EXPECT_EQ(cost.blurs.empty(), budget < 12) << budget;
  }
}

TEST(LevenbergMarquardt, TakesStepsOfDifferencesWhereNeighboursAreDrawn) {
  const SearchRegion region = test::tracking_region(9);
  RecordingCost cost(9, test::sphere(region, test::hidden_target(region, 3)));
  cost.linearizes = cost.draws = true;
  LevenbergMarquardtParams params;
  params.difference = 0.07;
  minimize(cost, region, 40, params);
  ASSERT_FALSE(cost.steps.empty());
  EXPECT_NEAR(cost.steps[0][0], 0.07 * region.spread[0], 1e-12);
}

TEST(LevenbergMarquardt, MakesItsOwnJacobianWhereItIsToldTo) {
  const SearchRegion region = test::tracking_region(9);
  RecordingCost cost(9, test::sphere(region, test::hidden_target(region, 3)));
  cost.linearizes = true;
  LevenbergMarquardtParams params;
  params.jacobian = JacobianMethod::numerical;
  minimize(cost, region, 100, params);
  EXPECT_TRUE(cost.blurs.empty());
  EXPECT_GT(std::ranges::count(cost.batches, 9), 0);
}

TEST(LevenbergMarquardt, SharpensSilhouettesWhereAStepNoLongerHelps) {
  const SearchRegion region = test::tracking_region(9);
  RecordingCost cost(9, test::sphere(region, region.start));
  cost.linearizes = true;
  LevenbergMarquardtParams params;
  params.blur = 2;
  params.finest = 0.25;
  const OptimizerResult result = minimize(cost, region, 1000, params);
  EXPECT_THAT(cost.blurs, ::testing::ElementsAre(2, 1, 0.5));
  EXPECT_LT(result.evaluations, 100);
}

TEST(LevenbergMarquardt, RefusesAnAnalyticJacobianThatIsNotThere) {
  const SearchRegion region = test::tracking_region(3);
  RecordingCost cost(3, test::sphere(region, region.start));
  LevenbergMarquardtParams params;
  params.jacobian = JacobianMethod::analytic;
  EXPECT_THAT(
      [&] { minimize(cost, region, 10, params); },
      ::testing::ThrowsMessage<ConfigError>(::testing::StartsWith(
          "the optimizer takes analytic Jacobians: no term of this cost that needs rendering "
          "has slopes or a Jacobian")));
}

TEST(LevenbergMarquardt, FollowsACurvedValley) {
  const SearchRegion region = test::tracking_region(12);
  RecordingCost cost(12, test::rosenbrock(region, test::hidden_target(region, 3)));
  EXPECT_LT(minimize(cost, region, 2000).cost, 1e-6);
}

TEST(LevenbergMarquardt, EndsWhenItHasConverged) {
  const SearchRegion region = test::tracking_region(27);
  RecordingCost cost(27, test::sphere(region, test::hidden_target(region, 3)));
  const OptimizerResult result = minimize(cost, region, 100000);
  EXPECT_LT(result.evaluations, 1000);
  EXPECT_LT(result.cost, 1e-8);
}

TEST(LevenbergMarquardt, MakesNoMoreJacobiansThanItIsAllowed) {
  const SearchRegion region = test::tracking_region(9);
  RecordingCost cost(9, test::rosenbrock(region, test::hidden_target(region, 3)));
  LevenbergMarquardtParams params;
  params.iterations = 4;
  minimize(cost, region, 100000, params);
  EXPECT_EQ(std::ranges::count(cost.batches, 9), 4);
}

TEST(LevenbergMarquardt, DifferencesPointInwardsAtABound) {
  SearchRegion region = test::tracking_region(8);
  region.upper[7] = region.start[7];
  region.lower[7] = -3;
  Eigen::VectorXd target = region.start;
  target[7] -= 0.5 * region.spread[7];
  RecordingCost cost(8, test::sphere(region, target));
  const OptimizerResult result = minimize(cost, region, 300);
  EXPECT_NEAR(result.point[7], target[7], 1e-3 * region.spread[7]);
  for (const Eigen::VectorXd& point : cost.points) EXPECT_LE(point[7], region.upper[7]);
}

TEST(LevenbergMarquardt, SolvesForTheOthersWhereOneIsHeldByItsBound) {
  SearchRegion region = test::tracking_region(8);
  Eigen::VectorXd target = test::hidden_target(region, 4);
  region.upper[7] = region.start[7];
  target[7] = region.start[7] + region.spread[7];
  // Coupled: what the held number cannot do, the others must not try to make up for.
  RecordingCost cost(8, Problem([=](const Eigen::VectorXd& x) -> Eigen::VectorXd {
                       Eigen::VectorXd u = test::offsets(region, target, x);
                       u[6] += 0.5 * u[7];
                       return u;
                     }));
  const OptimizerResult result = minimize(cost, region, 600);
  EXPECT_EQ(result.point[7], region.upper[7]);
  EXPECT_NEAR((result.point[6] - target[6]) / region.spread[6], 0.5, 1e-3);
}

TEST(LevenbergMarquardt, LeavesNumbersAloneThatNothingDependsOn) {
  const SearchRegion region = test::tracking_region(10);
  RecordingCost cost(10, Problem([&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
                       return (x - region.start).head(5).array() - 0.01;
                     }));
  const OptimizerResult result = minimize(cost, region, 500);
  EXPECT_EQ(result.point.tail(5), region.start.tail(5));
  EXPECT_LT(result.cost, cost.costs[0]);
}

TEST(LevenbergMarquardt, NeedsResidualsWithinOtherOptimizersToo) {
  const auto least_squares = [] {
    return std::make_unique<LevenbergMarquardt>(LevenbergMarquardtParams{});
  };
  EXPECT_TRUE(MultiStart({}, least_squares()).requirements().least_squares);
  EXPECT_TRUE(LimbSearch({}, least_squares()).requirements().least_squares);
  EXPECT_FALSE(MultiStart({}, std::make_unique<RandomSearch>(RandomSearchParams{}))
                   .requirements()
                   .least_squares);
  std::vector<PipelineStage> stages;
  stages.push_back({"random_search", std::make_unique<RandomSearch>(RandomSearchParams{})});
  stages.push_back({"levenberg_marquardt", least_squares()});
  EXPECT_TRUE(Pipeline(std::move(stages), 100).requirements().least_squares);
}

TEST(LevenbergMarquardt, SaysWhatItWantsOfAnalyticJacobiansWithinOtherOptimizersToo) {
  const auto with = [](JacobianMethod jacobian) {
    LevenbergMarquardtParams params;
    params.jacobian = jacobian;
    return std::make_unique<LevenbergMarquardt>(params);
  };
  EXPECT_EQ(with(JacobianMethod::numerical)->requirements().jacobian, Linearization::unused);
  EXPECT_EQ(with(JacobianMethod::automatic)->requirements().jacobian, Linearization::welcome);
  EXPECT_EQ(MultiStart({}, with(JacobianMethod::analytic)).requirements().jacobian,
            Linearization::needed);
  EXPECT_EQ(LimbSearch({}, with(JacobianMethod::analytic)).requirements().jacobian,
            Linearization::needed);
  const auto of_stages = [&](JacobianMethod first, JacobianMethod second) {
    std::vector<PipelineStage> stages;
    stages.push_back({"levenberg_marquardt", with(first)});
    stages.push_back({"levenberg_marquardt", with(second)});
    return Pipeline(std::move(stages), 100).requirements().jacobian;
  };
  EXPECT_EQ(of_stages(JacobianMethod::analytic, JacobianMethod::numerical), Linearization::needed);
  EXPECT_EQ(of_stages(JacobianMethod::numerical, JacobianMethod::automatic),
            Linearization::welcome);
  EXPECT_EQ(of_stages(JacobianMethod::numerical, JacobianMethod::numerical), Linearization::unused);
}

TEST(LeastSquares, ASearchWithoutResidualsAsksForNoJacobian) {
  Requirements all{.jacobian = Linearization::needed};
  all.merge({.least_squares = true});
  EXPECT_TRUE(all.least_squares);
  EXPECT_EQ(all.jacobian, Linearization::unused);
  all.merge({.jacobian = Linearization::needed});
  EXPECT_EQ(all.jacobian, Linearization::unused);
}

/// A cost that keeps its residuals to itself.
class Reticent final : public CostFunction, public ResidualCost {
 public:
  explicit Reticent(RecordingCost& cost) : cost_(cost) {}
  int dimension() const override { return cost_.dimension(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    cost_.evaluate(points, costs);
  }
  ResidualCost* residuals() override { return this; }
  Eigen::Index count() const override { return cost_.count(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>&, Eigen::Ref<Eigen::MatrixXf>,
                Eigen::Ref<Eigen::VectorXd>) override {
    FAIL() << "residuals were asked for";
  }
  std::unique_ptr<ResidualDifferences> differences() override {
    ++asked;
    return cost_.differences();
  }

  int asked = 0;

 private:
  RecordingCost& cost_;
};

TEST(LevenbergMarquardt, SearchesOfSeveralRegionsShareBatches) {
  const SearchRegion region = test::tracking_region(12);
  const Problem valley = test::rosenbrock(region, test::hidden_target(region, 3));
  std::vector<SearchRegion> regions(3, region);
  regions[1].start = within_bounds(region.start + 0.2 * region.spread, region);
  regions[2].lower.head<5>() = regions[2].upper.head<5>() = regions[2].start.head<5>();
  for (const bool linearizes : {true, false}) {
    RecordingCost cost(12, valley);
    cost.linearizes = linearizes;
    LevenbergMarquardt optimizer({});
    const std::vector<OptimizerResult> found = optimizer.minimize_each(cost, regions, {200}, 1);
    ASSERT_EQ(found.size(), 3u);
    std::size_t alone = 0;  // batches
    for (std::size_t k = 0; k < 3; ++k) {
      RecordingCost own(12, valley);
      own.linearizes = linearizes;
      const OptimizerResult expected = optimizer.minimize(own, regions[k], {200}, 1);
      EXPECT_EQ(found[k].point, expected.point) << k;
      EXPECT_EQ(found[k].cost, expected.cost) << k;
      EXPECT_EQ(found[k].evaluations, expected.evaluations) << k;
      alone = std::max(alone, own.batches.size());
    }
    if (linearizes) {
      EXPECT_LE(cost.batches.size(), alone + 20);
      EXPECT_EQ(cost.batches.front(), 3);
    }
  }
}

TEST(LevenbergMarquardt, StartsShareTheEvaluationsAndTheBestCounts) {
  const SearchRegion region = test::tracking_region(12);
  RecordingCost cost(12, test::rosenbrock(region, test::hidden_target(region, 3)));
  cost.linearizes = true;
  LevenbergMarquardtParams params;
  params.restarts = 7;
  params.iterations = 2;
  const OptimizerResult result = minimize(cost, region, 100, params);
  EXPECT_EQ(cost.batches.front(), 7);
  EXPECT_EQ(cost.points.front(), region.start);
  EXPECT_EQ(result.cost, *std::ranges::min_element(cost.costs));
  EXPECT_LE(result.evaluations, 100);
  EXPECT_EQ(result.evaluations, static_cast<std::int64_t>(cost.points.size() + cost.blurs.size()));
}

TEST(LevenbergMarquardt, LeavesResidualsWhereTheCostKeepsThem) {
  const SearchRegion region = test::tracking_region(27);
  const Problem problem = test::ellipsoid(region, region.start + 0.5 * region.spread);
  RecordingCost open(27, problem), hidden(27, problem);
  Reticent reticent(hidden);
  const OptimizerResult expected = minimize(open, region, 200);
  const OptimizerResult found = LevenbergMarquardt({}).minimize(reticent, region, {200}, 1);
  EXPECT_EQ(reticent.asked, 1);
  EXPECT_EQ(found.point, expected.point);
  EXPECT_EQ(found.evaluations, expected.evaluations);
  EXPECT_LT(found.cost, open.costs[0]);
}

TEST(LevenbergMarquardt, RefusesACostWithoutResiduals) {
  const SearchRegion region = test::tracking_region(3);
  RecordingCost cost(3, test::sphere(region, region.start));
  cost.has_residuals = false;
  EXPECT_THAT([&] { minimize(cost, region, 10); },
              ::testing::ThrowsMessage<ConfigError>(
                  "objective: the optimizer needs residuals: this cost has none; take an optimizer "
                  "that needs costs only, such as `optimizer: {type: pso}`"));
}

}  // namespace
}  // namespace hypotrack
