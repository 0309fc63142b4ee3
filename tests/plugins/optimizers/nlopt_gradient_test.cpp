// The algorithms of NLopt that follow gradients of the residuals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hypotrack/api/error.hpp"
#include "nlopt_optimizer.hpp"
#include "scaled_problem.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

using test::RecordingCost;

NloptParams follows_gradients_by(const std::string& algorithm) {
  NloptParams params;
  params.algorithm = algorithm;
  return params;
}

/// Evaluations of a recording cost, analytic Jacobians included.
std::int64_t evaluations(const RecordingCost& cost) {
  return static_cast<std::int64_t>(cost.points.size() + cost.blurs.size());
}

class NloptGradient : public ::testing::TestWithParam<std::string> {
 protected:
  OptimizerResult minimize(RecordingCost& cost, const SearchRegion& region, std::int64_t budget) {
    return Nlopt(follows_gradients_by(GetParam())).minimize(cost, region, {budget}, 1);
  }
};

TEST_P(NloptGradient, FindsAMinimumWithAnalyticJacobiansInFewEvaluations) {
  const SearchRegion region = test::tracking_region(27);
  RecordingCost cost(27, test::sphere(region, test::hidden_target(region, 3)));
  cost.linearizes = true;
  const OptimizerResult result = minimize(cost, region, 200);
  EXPECT_LT(result.cost, 1e-4 * cost.costs[0]);
  EXPECT_EQ(result.evaluations, evaluations(cost));
}

TEST_P(NloptGradient, CountsJacobiansAndKeepsTheBudget) {
  const SearchRegion region = test::tracking_region(9);
  for (const bool linearizes : {true, false}) {
    for (const std::int64_t budget : {1, 2, 3, 10, 11, 12, 57}) {
      RecordingCost cost(9, test::rosenbrock(region, test::hidden_target(region, 3)));
      cost.linearizes = linearizes;
      const OptimizerResult result = minimize(cost, region, budget);
      EXPECT_LE(result.evaluations, budget);
      EXPECT_EQ(result.evaluations, evaluations(cost));
      EXPECT_EQ(result.cost, *std::ranges::min_element(cost.costs));
      EXPECT_EQ(cost.points.front(), region.start);
    }
  }
}

TEST_P(NloptGradient, RefusesACostWithoutResiduals) {
  const SearchRegion region = test::tracking_region(3);
  RecordingCost cost(3, test::sphere(region, region.start));
  cost.has_residuals = false;
  EXPECT_TRUE(Nlopt(follows_gradients_by(GetParam())).requirements().least_squares);
  EXPECT_THAT([&] { minimize(cost, region, 10); },
              ::testing::ThrowsMessage<ConfigError>(
                  "objective: the optimizer needs residuals: this cost has none; take an optimizer "
                  "that needs costs only, such as `optimizer: {type: pso}`"));
}

INSTANTIATE_TEST_SUITE_P(All, NloptGradient,
                         ::testing::Values("LBFGS", "VAR1", "VAR2", "TNEWTON", "TNEWTON_RESTART",
                                           "TNEWTON_PRECOND", "TNEWTON_PRECOND_RESTART", "SLSQP",
                                           "MMA", "CCSAQ"));

TEST(NloptGradients, AgreeWithDifferencesOfTheCostOverTheFreeDimensions) {
  SearchRegion region = test::tracking_region(12);
  for (const int d : {0, 5, 11}) region.lower[d] = region.upper[d] = region.start[d];
  for (const bool linearizes : {true, false}) {
    RecordingCost cost(12, test::ellipsoid(region, region.start.array() + 0.1));
    cost.linearizes = linearizes;
    ScaledProblem problem(cost, region, {1000});
    problem.use_gradient({});
    problem.evaluate_start();
    ASSERT_EQ(problem.dimension(), 9);
    Eigen::VectorXd at = Eigen::VectorXd::LinSpaced(9, -0.05, 0.05), gradient(9);
    const auto value = [&](const Eigen::VectorXd& offsets, double* slopes) {
      return ScaledProblem::callback(9, offsets.data(), slopes, &problem);
    };
    value(at, gradient.data());
    for (int i = 0; i < 9; ++i) {
      const Eigen::VectorXd step = 1e-4 * Eigen::VectorXd::Unit(9, i);
      const double slope = (value(at + step, nullptr) - value(at - step, nullptr)) / 2e-4;
      // Differences of residuals in single precision.
      EXPECT_NEAR(gradient[i], slope, 1e-3 * std::abs(slope) + 1e-3) << i << ' ' << linearizes;
    }
  }
}

TEST(NloptGradients, TakeOneEvaluationOrOnePerDimension) {
  const SearchRegion region = test::tracking_region(9);
  for (const bool linearizes : {true, false}) {
    RecordingCost cost(9, test::sphere(region, test::hidden_target(region, 3)));
    cost.linearizes = linearizes;
    ScaledProblem problem(cost, region, {100});
    problem.use_gradient({});
    problem.evaluate_start();
    EXPECT_EQ(problem.remaining(), 99);
    const Eigen::VectorXd start = Eigen::VectorXd::Zero(9);
    Eigen::VectorXd gradient(9);
    ScaledProblem::callback(9, start.data(), gradient.data(), &problem);
    EXPECT_EQ(problem.remaining(), linearizes ? 98 : 90) << "the start is not evaluated again";
    const Eigen::VectorXd elsewhere = Eigen::VectorXd::Constant(9, 0.1);
    ScaledProblem::callback(9, elsewhere.data(), nullptr, &problem);
    ScaledProblem::callback(9, elsewhere.data(), gradient.data(), &problem);
    EXPECT_EQ(problem.remaining(), linearizes ? 96 : 80) << "nor is the last point";
  }
}

TEST(NloptGradients, TakeOneEvaluationMoreThanDimensionsWhereNeighboursAreDrawn) {
  const SearchRegion region = test::tracking_region(9);
  RecordingCost cost(9, test::sphere(region, test::hidden_target(region, 3)));
  cost.linearizes = cost.draws = true;
  const OptimizerResult result =
      Nlopt(follows_gradients_by("LBFGS")).minimize(cost, region, {60}, 1);
  EXPECT_EQ(result.evaluations, cost.evaluations());
  EXPECT_LE(result.evaluations, 60);
  EXPECT_FALSE(cost.blurs.empty());
}

TEST(NloptGradients, BlurIsThatOfTheParameters) {
  const SearchRegion region = test::tracking_region(9);
  RecordingCost cost(9, test::sphere(region, test::hidden_target(region, 3)));
  cost.linearizes = true;
  NloptParams params = follows_gradients_by("LBFGS");
  params.gradient.blur = 0.75;
  Nlopt(params).minimize(cost, region, {20}, 1);
  EXPECT_THAT(cost.blurs, ::testing::Each(0.75));
  EXPECT_FALSE(cost.blurs.empty());
}

TEST(NloptGradients, ServeTheLocalSearchesOfMlsl) {
  const SearchRegion region = test::tracking_region(9);
  RecordingCost cost(9, test::sphere(region, test::hidden_target(region, 3)));
  cost.linearizes = true;
  NloptParams params = follows_gradients_by("MLSL_LDS");
  EXPECT_FALSE(Nlopt(params).requirements().least_squares);
  params.local = "LBFGS";
  EXPECT_TRUE(Nlopt(params).requirements().least_squares);
  const OptimizerResult result = Nlopt(params).minimize(cost, region, {200}, 1);
  EXPECT_LT(result.cost, 1e-4 * cost.costs[0]);
  EXPECT_EQ(result.evaluations, evaluations(cost));
  EXPECT_LE(result.evaluations, 200);
}

}  // namespace
}  // namespace hypotrack
