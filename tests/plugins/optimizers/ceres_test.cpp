// The trust-region methods of Ceres on reduced residuals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "ceres/ceres_optimizer.hpp"
#include "ceres/reduced_problem.hpp"
#include "hypotrack/api/error.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

using test::Problem;
using test::RecordingCost;

constexpr double kInfeasible = std::numeric_limits<double>::infinity();

TEST(ReducedResiduals, HaveTheNormalEquationsOfTheFullOnesAlsoIfSingular) {
  Eigen::MatrixXd j = Eigen::MatrixXd::Random(50, 7);
  j.col(3).setZero();
  j.col(5) = 2 * j.col(1);
  const Eigen::VectorXd r = Eigen::VectorXd::Random(50);
  const NormalEquations full{j.transpose() * j, j.transpose() * r};
  const ReducedResiduals reduced = reduce(full);
  EXPECT_TRUE((reduced.jacobian.transpose() * reduced.jacobian).isApprox(full.a, 1e-10));
  EXPECT_TRUE((reduced.jacobian.transpose() * reduced.residuals).isApprox(full.g, 1e-10));
  EXPECT_LE(reduced.residuals.norm(), r.norm());
}

class Ceres : public ::testing::TestWithParam<TrustRegion> {
 protected:
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget) {
    CeresParams params;
    params.strategy = GetParam();
    return CeresOptimizer(params).minimize(cost, region, budget, 1);
  }

  static void expect_contract(const RecordingCost& cost, const OptimizerResult& result,
                              const SearchRegion& region, std::int64_t budget) {
    EXPECT_EQ(cost.points.front(), region.start);
    EXPECT_EQ(result.evaluations,
              static_cast<std::int64_t>(cost.points.size() + cost.blurs.size()));
    EXPECT_LE(result.evaluations, budget);
    EXPECT_EQ(result.cost, *std::ranges::min_element(cost.costs));
    for (const Eigen::VectorXd& point : cost.points) {
      ASSERT_TRUE((point.array() >= region.lower.array()).all() &&
                  (point.array() <= region.upper.array()).all());
    }
  }
};

TEST_P(Ceres, SolvesALinearProblemInFewEvaluations) {
  const SearchRegion region = test::tracking_region(27);
  RecordingCost cost(27, test::ellipsoid(region, test::hidden_target(region, 3)));
  cost.linearizes = true;
  const OptimizerResult result = minimize(cost, region, {40});
  expect_contract(cost, result, region, 40);
  EXPECT_LT(result.cost, 1e-6 * cost.costs[0]);
}

TEST_P(Ceres, FollowsACurvedValley) {
  const SearchRegion region = test::tracking_region(12);
  RecordingCost cost(12, test::rosenbrock(region, test::hidden_target(region, 3)));
  EXPECT_LT(minimize(cost, region, {2000}).cost, 1e-6);
}

TEST_P(Ceres, EndsWhenItHasConverged) {
  const SearchRegion region = test::tracking_region(27);
  RecordingCost cost(27, test::rosenbrock(region, region.start));
  const OptimizerResult result = minimize(cost, region, {100000});
  EXPECT_LT(result.evaluations, 5000);
}

TEST_P(Ceres, CountsJacobiansAndKeepsTheBudget) {
  const SearchRegion region = test::tracking_region(9);
  for (const bool linearizes : {true, false}) {
    for (const std::int64_t budget : {1, 2, 3, 10, 11, 12, 57}) {
      RecordingCost cost(9, test::rosenbrock(region, test::hidden_target(region, 3)));
      cost.linearizes = linearizes;
      expect_contract(cost, minimize(cost, region, {budget}), region, budget);
    }
  }
}

TEST_P(Ceres, CountsTheNeighboursThatAJacobianTakes) {
  const SearchRegion region = test::tracking_region(9);
  for (const std::int64_t budget : {1, 10, 11, 12, 57}) {
    RecordingCost cost(9, test::rosenbrock(region, test::hidden_target(region, 3)));
    cost.linearizes = cost.draws = true;
    const OptimizerResult result = minimize(cost, region, {budget});
    EXPECT_EQ(result.evaluations, cost.evaluations());
    EXPECT_LE(result.evaluations, budget);
  }
}

TEST_P(Ceres, WritesNothingOnStderrWhereTheBudgetEndsOrAnExceptionDoes) {
  const SearchRegion region = test::tracking_region(9);
  testing::internal::CaptureStderr();
  for (std::int64_t budget = 1; budget < 60; ++budget) {
    RecordingCost cost(9, test::rosenbrock(region, test::hidden_target(region, 3)));
    minimize(cost, region, {budget});
    int calls = 0;
    const Problem valley = test::rosenbrock(region, test::hidden_target(region, 3));
    RecordingCost fails(9, [&](const Eigen::VectorXd& x) {
      if (++calls == budget) throw DataError("it broke");
      return valley(x);
    });
    try {
      minimize(fails, region, {budget});  // may end before
    } catch (const DataError&) {
    }
    RecordingCost infeasible(9, [](const Eigen::VectorXd&) { return kInfeasible; });
    minimize(infeasible, region, {budget});
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_P(Ceres, BoundsHoldWhereTheOptimumLiesBeyondThem) {
  const SearchRegion region = test::tracking_region(27);
  const Eigen::VectorXd target = region.start.array() + 3.0;
  for (const bool linearizes : {true, false}) {
    RecordingCost cost(27, test::sphere(region, target));
    cost.linearizes = linearizes;
    const OptimizerResult result = minimize(cost, region, {600});
    expect_contract(cost, result, region, 600);
    EXPECT_TRUE(result.point.isApprox(target.cwiseMin(region.upper), 1e-3));
  }
}

TEST_P(Ceres, SameAnswerAlsoInTheMiddleOfOtherSearches) {
  const SearchRegion region = test::tracking_region(27);
  const Problem problem = test::rosenbrock(region, test::hidden_target(region, 5));
  RecordingCost first(27, problem), other(27, problem), second(27, problem);
  minimize(first, region, {400});
  minimize(other, region, {333});
  minimize(second, region, {400});
  EXPECT_EQ(first.points, second.points);
}

TEST_P(Ceres, StepsDoNotDependOnAConstantInTheCost) {
  const SearchRegion region = test::tracking_region(12);
  const Problem valley = test::rosenbrock(region, test::hidden_target(region, 3));
  // A cost below its sum of squares, as that of a term with a constant is.
  class Shifted final : public CostFunction, public ResidualCost {
   public:
    explicit Shifted(RecordingCost& cost) : cost_(cost) {}
    int dimension() const override { return cost_.dimension(); }
    void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                  Eigen::Ref<Eigen::VectorXd> costs) override {
      cost_.evaluate(points, costs);
      costs.array() -= 1000;
    }
    ResidualCost* residuals() override { return this; }
    Eigen::Index count() const override { return cost_.count(); }
    void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                  Eigen::Ref<Eigen::MatrixXf> residuals,
                  Eigen::Ref<Eigen::VectorXd> costs) override {
      cost_.evaluate(points, residuals, costs);
      costs.array() -= 1000;
    }

   private:
    RecordingCost& cost_;
  };
  RecordingCost plain(12, valley), inner(12, valley);
  Shifted shifted(inner);
  const OptimizerResult expected = minimize(plain, region, {300});
  const OptimizerResult found = minimize(shifted, region, {300});
  EXPECT_TRUE(found.point.isApprox(expected.point, 1e-6));
}

TEST_P(Ceres, LeavesAnInfeasibleStart) {
  const SearchRegion region = test::tracking_region(4);
  for (const bool linearizes : {true, false}) {
    RecordingCost cost(4, [&](const Eigen::VectorXd& x) {
      return x[0] <= region.start[0] ? kInfeasible : (x - region.start).squaredNorm();
    });
    cost.linearizes = linearizes;
    const OptimizerResult result = minimize(cost, region, {500});
    EXPECT_TRUE(std::isfinite(result.cost));
    EXPECT_EQ(result.evaluations,
              static_cast<std::int64_t>(cost.points.size() + cost.blurs.size()));
  }
}

TEST_P(Ceres, ExceptionsOfTheCostPassThroughUnchanged) {
  struct Special : std::runtime_error {
    using std::runtime_error::runtime_error;
  };
  const SearchRegion region = test::tracking_region(27);
  for (const int when : {0, 1, 40}) {
    int calls = 0;
    RecordingCost cost(27, [&](const Eigen::VectorXd& x) {
      if (calls++ == when) throw Special("a very particular problem");
      return x.squaredNorm();
    });
    EXPECT_THAT([&] { minimize(cost, region, {500}); },
                ::testing::ThrowsMessage<Special>("a very particular problem"));
    EXPECT_EQ(calls, when + 1) << "nothing is evaluated after an exception";
  }
}

TEST_P(Ceres, RefusesACostWithoutResiduals) {
  const SearchRegion region = test::tracking_region(3);
  RecordingCost cost(3, test::sphere(region, region.start));
  cost.has_residuals = false;
  EXPECT_THAT([&] { minimize(cost, region, {10}); },
              ::testing::ThrowsMessage<ConfigError>(
                  "objective: the optimizer needs residuals: this cost has none; take an optimizer "
                  "that needs costs only, such as `optimizer: {type: pso}`"));
}

INSTANTIATE_TEST_SUITE_P(Strategies, Ceres,
                         ::testing::Values(TrustRegion::levenberg_marquardt, TrustRegion::dogleg,
                                           TrustRegion::subspace_dogleg),
                         [](const auto& each) {
                           return std::string(
                               enum_names(each.param)[static_cast<std::size_t>(each.param)]);
                         });

}  // namespace
}  // namespace hypotrack
