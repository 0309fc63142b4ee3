#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "hypotrack/api/error.hpp"
#include "nlopt_optimizer.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

NloptParams with(const std::string& algorithm) {
  NloptParams params;
  params.algorithm = algorithm;
  return params;
}

struct Refusal {
  std::string algorithm;
  std::string reason;
};

class NloptRefuses : public ::testing::TestWithParam<Refusal> {};

TEST_P(NloptRefuses, SayingWhyAndWhatIsAllowed) {
  EXPECT_THAT([] { Nlopt(with(GetParam().algorithm), "scene.yaml:9:3"); },
              ThrowsMessage<ConfigError>(AllOf(
                  HasSubstr("scene.yaml:9:3: algorithm is '" + GetParam().algorithm + "'"),
                  HasSubstr(GetParam().reason),
                  HasSubstr("expected one of SBPLX, NELDERMEAD, COBYLA, BOBYQA, PRAXIS, LBFGS, "
                            "VAR1, VAR2, TNEWTON, TNEWTON_RESTART, TNEWTON_PRECOND, "
                            "TNEWTON_PRECOND_RESTART, SLSQP, MMA, CCSAQ, CRS2_LM, ESCH, ISRES, "
                            "DIRECT, DIRECT_L, DIRECT_L_RAND, ORIG_DIRECT_L, MLSL_LDS"))));
}

INSTANTIATE_TEST_SUITE_P(
    Algorithms, NloptRefuses,
    ::testing::Values(
        Refusal{"NEWUOA_BOUND", "never returns"}, Refusal{"LN_NEWUOA_BOUND", "never returns"},
        Refusal{"NEWUOA", "it knows no bounds"}, Refusal{"LBFGS_NOCEDAL", "licence"},
        Refusal{"NLOPT_LD_TNEWTON_PRECOND", "write TNEWTON_PRECOND"},
        Refusal{"STOGO_RAND", "Debian builds NLopt without it"}, Refusal{"AUGLAG", "constraints"},
        Refusal{"AGS", "at most ten dimensions"}, Refusal{"SUBPLEX", "licence"},
        Refusal{"DIRECT_L_NOSCAL", "scaled by the region's spread"},
        Refusal{"GN_CRS2_LM", "write CRS2_LM"}, Refusal{"sbplx", "there is no such algorithm"}),
    [](const auto& each) { return each.param.algorithm; });

TEST(Nlopt, OnlyBoundedLocalAlgorithmsServeMlsl) {
  NloptParams params = with("MLSL_LDS");
  params.local = "PRAXIS";
  EXPECT_THAT([&] { Nlopt(params, "s:1:1"); },
              ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr("s:1:1: local is 'PRAXIS': it is no local algorithm"),
                        HasSubstr("expected one of SBPLX, NELDERMEAD, COBYLA, BOBYQA, LBFGS, "))));
}

TEST(Nlopt, APopulationThatCrsCannotUseIsRefused) {
  NloptParams params = with("CRS2_LM");
  params.population = 27;
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, region.start));
  EXPECT_THAT([&] { Nlopt(params, "s:1:1").minimize(cost, region, {100}, 1); },
              ThrowsMessage<ConfigError>(
                  HasSubstr("population is 27, expected more than the search's 27 dimensions")));
}

TEST(Nlopt, DirectRefusesBudgetsThatDoNotFitIntoMemory) {
  const SearchRegion region = test::tracking_region(54);
  test::RecordingCost cost(54, test::sphere(region, region.start));
  EXPECT_THAT([&] { Nlopt(with("ORIG_DIRECT_L")).minimize(cost, region, {100'000'000}, 1); },
              ThrowsMessage<ConfigError>(AllOf(HasSubstr("100000000 evaluations in 54 dimensions"),
                                               HasSubstr("expected at most 621378 evaluations"))));
}

TEST(Nlopt, AutomaticPopulationsLeaveRoomForGenerations) {
  using Population = NloptAlgorithm::Population;
  EXPECT_EQ(automatic_population(Population::crs, 27, 1024), 64u);
  EXPECT_EQ(automatic_population(Population::crs, 27, 100), 29u);      // more than the dimensions
  EXPECT_EQ(automatic_population(Population::crs, 27, 100000), 280u);  // NLopt's own
  EXPECT_EQ(automatic_population(Population::isres, 27, 1024), 16u);
  EXPECT_EQ(automatic_population(Population::esch, 27, 1024), 8u);
  EXPECT_EQ(automatic_population(Population::mlsl, 27, 1024), 4u);
  EXPECT_EQ(automatic_population(Population::mlsl, 27, 1), 2u);
}

TEST(Nlopt, GlobalAlgorithmsStayWithinTheBoxAndLocalOnesNeedNot) {
  const SearchRegion region = test::tracking_region(3);  // infinite bounds
  const Eigen::VectorXd target = region.start + 5 * region.spread;
  NloptParams params = with("CRS2_LM");
  params.box = 2;
  test::RecordingCost boxed(3, test::sphere(region, target));
  Nlopt(params).minimize(boxed, region, {300}, 1);
  for (const auto& point : boxed.points) {
    EXPECT_LE((point - region.start).cwiseQuotient(region.spread).cwiseAbs().maxCoeff(), 2 + 1e-12);
  }
  test::RecordingCost local(3, test::sphere(region, target));
  EXPECT_LT(Nlopt(with("SBPLX")).minimize(local, region, {300}, 1).cost, 1e-3);
}

TEST(Nlopt, TheFirstStepIsAShareOfTheSpread) {
  const SearchRegion region = test::tracking_region(3);
  NloptParams params = with("SBPLX");
  params.step = 0.25;
  test::RecordingCost cost(3, test::sphere(region, region.start));
  Nlopt(params).minimize(cost, region, {2}, 1);
  EXPECT_NEAR((cost.points[1] - region.start).cwiseQuotient(region.spread).cwiseAbs().maxCoeff(),
              0.25, 1e-12);
}

TEST(Nlopt, PraxisIsClampedToTheBounds) {
  SearchRegion region = test::tracking_region(8);
  region.start[7] = region.upper[7] - 0.01;
  // The cost falls beyond the bound: what an unbounded method would follow.
  test::RecordingCost cost(8, [&](const Eigen::VectorXd& x) {
    return (x - region.start).cwiseQuotient(region.spread).head(7).squaredNorm() - x[7];
  });
  const OptimizerResult result = Nlopt(with("PRAXIS")).minimize(cost, region, {500}, 1);
  EXPECT_LE(result.point[7], region.upper[7]);
  EXPECT_NEAR(result.point[7], region.upper[7], 1e-9);
}

TEST(Nlopt, ATimeBudgetEndsTheSearch) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, region.start));
  const OptimizerResult result = Nlopt(with("ISRES")).minimize(cost, region, {10000, 0.0}, 1);
  EXPECT_LE(result.evaluations, 2);
}

}  // namespace
}  // namespace hypotrack
