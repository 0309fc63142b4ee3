// Terms as a sum of squares.
#include <gmock/gmock.h>

#include "cost/cuda/device.hpp"
#include "cost_fixture.hpp"
#include "expect_error.hpp"

namespace hypotrack::test {
namespace {

using CostResiduals = CostTest;

struct DrawnSquares final : SquaresOfState {
  using SquaresOfState::SquaresOfState;
  bool do_needs_rendering() const override { return true; }
};

TEST_F(CostResiduals, ResidualsOfAllTermsAddUpToTheirWeightedSum) {
  const std::vector<ObjectiveTerm> terms = {{4, std::make_shared<SquaresOfState>(3)},
                                            {0, drawn(total_inverse_depth)},
                                            {1, std::make_shared<SquaresOfState>(10)}};
  const Eigen::MatrixXd states = random_states(40);
  Eigen::MatrixXf expected;
  for (const int count : {1, 3}) {
    const auto cost = make_cost(scene_, terms, threads(count), {.least_squares = true});
    cost->prepare(observation_);
    ASSERT_EQ(cost->least_squares()->count(), 13);
    Eigen::MatrixXf residuals(13, 40);
    Eigen::VectorXd costs(40);
    cost->least_squares()->evaluate(states, residuals, costs);
    EXPECT_EQ(costs, evaluate(terms, states));
    EXPECT_TRUE(residuals.colwise().squaredNorm().transpose().isApprox(costs.cast<float>(), 1e-5f));
    EXPECT_TRUE(residuals.topRows(3).isApprox(2 * states.topRows(3).cast<float>(), 1e-6f));
    if (expected.size() == 0) expected = residuals;
    EXPECT_EQ(residuals, expected);
  }
}

TEST_F(CostResiduals, RefusesResidualsOfTermsThatHaveNone) {
  const auto squares = std::make_shared<SquaresOfState>(3);
  const auto plain = undrawn([](const RenderedHypothesis&) { return 0.0; });
  const auto why = [&](std::vector<ObjectiveTerm> terms, Backend backend) -> std::string {
    try {
      make_cost(scene_, std::move(terms), {.backend = backend}, {.least_squares = true});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(
      why({{1, squares}, {1, plain, "prior"}}, Backend::cpu),
      testing::StartsWith("objective: the optimizer needs residuals: objective prior, as it "
                          "is set up, offers no residuals"));
  EXPECT_THAT(why({{-2, squares, "prior"}}, Backend::cpu),
              testing::HasSubstr("the weight of objective prior is -2, and squares cannot be"));
  EXPECT_EQ(why({{1, squares}, {0, plain}}, Backend::cpu), "no error");
}

TEST_F(CostResiduals, RefusesAnalyticJacobiansOnAGpuOfTermsWithoutSlopesThere) {
  if (const std::string why = cuda::why_no_device(); why.ends_with("built without CUDA"))
    GTEST_SKIP() << why;
  const std::vector<ObjectiveTerm> terms = {{1, std::make_shared<DrawnSquares>(3), "squares"}};
  EXPECT_EQ(message_of<ConfigError>([&] {
              make_cost(scene_, terms, {.backend = Backend::cuda},
                        {.least_squares = true, .jacobian = Linearization::needed});
            }),
            "the optimizer takes analytic Jacobians: objective squares has no slopes of its "
            "residuals on a GPU. Write `jacobian: auto` or `numerical` in the optimizer, or "
            "`backend: cpu`");
}

TEST_F(CostResiduals, RefusesAnalyticJacobiansOfTermsWithoutSlopes) {
  const std::vector<ObjectiveTerm> terms = {{1, std::make_shared<DrawnSquares>(3)}};
  EXPECT_THAT(
      message_of<ConfigError>([&] {
        make_cost(scene_, terms, threads(1),
                  {.least_squares = true, .jacobian = Linearization::needed});
      }),
      testing::EndsWith("no term that needs rendering has slopes or a Jacobian of its "
                        "residuals. Write `jacobian: auto` or `numerical` in the optimizer"));
  EXPECT_NO_THROW(make_cost(scene_, terms, threads(1),
                            {.least_squares = true, .jacobian = Linearization::welcome}));
}

TEST_F(CostResiduals, SaysWhichResidualsLookAtThePoseOnlyWhereItFellBackToo) {
  for (const auto backend : {Backend::cpu, Backend::automatic}) {
    const auto cost = make_cost(
        scene_, {{1, std::make_shared<DrawnSquares>(4)}, {1, std::make_shared<SquaresOfState>(3)}},
        {.backend = backend, .threads = 1}, {.least_squares = true});
    cost->prepare(observation_);
    const std::vector<ResidualRows> rows = cost->least_squares()->pose_only();
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].first, 4);
    EXPECT_EQ(rows[0].count, 3);
  }
}

TEST_F(CostResiduals, SaysWhetherThereAreResidualsThatNobodyAnnounced) {
  EXPECT_TRUE(
      make_cost(scene_, {{1, std::make_shared<SquaresOfState>(3)}}, threads(1))->least_squares());
  EXPECT_FALSE(make_cost(scene_, {{1, drawn(total_inverse_depth)}}, threads(1))->least_squares());
}

}  // namespace
}  // namespace hypotrack::test
