#include "lab/report/trace/profiles.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>

namespace hypotrack {
namespace {

using testing::ElementsAre;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Profiles, RunningTimeIsWhatAllTrialsSpentOverThoseThatReachedTheTarget) {
  // 100 + 200 + 300 evaluations, two successes.
  const std::array<Trial, 3> some{{{100, true}, {200, false}, {300, true}}};
  EXPECT_EQ(expected_running_time(some), 300);
  const std::array<Trial, 2> all{{{100, true}, {300, true}}};
  EXPECT_EQ(expected_running_time(all), 200);
  const std::array<Trial, 2> none{{{100, false}, {300, false}}};
  EXPECT_EQ(expected_running_time(none), kInfinity);
}

TEST(Profiles, TheDistributionOfRunningTimesCountsFailuresAsNeverReached) {
  const std::array numbers{100.0, kInfinity, 300.0, 300.0};
  EXPECT_EQ(share_within(numbers, 99), 0);
  EXPECT_EQ(share_within(numbers, 100), 0.25);
  EXPECT_EQ(share_within(numbers, 299), 0.25);
  EXPECT_EQ(share_within(numbers, 300), 0.75);
  EXPECT_EQ(share_within(numbers, 1e9), 0.75);
}

TEST(Profiles, APerformanceProfileIsTheShareOfProblemsWithinAFactorOfTheFastest) {
  // Two solvers on three problems: 10 and 20, 40 and 10, never and 30 evaluations.
  const std::array<std::array<Trial, 2>, 3> problems{
      {{{{10, true}, {20, true}}}, {{{40, true}, {10, true}}}, {{{99, false}, {30, true}}}}};
  std::array<std::vector<double>, 2> ratios;
  for (const auto& problem : problems) {
    const std::vector<double> of_problem = performance_ratios(problem);
    for (std::size_t s = 0; s < 2; ++s) ratios[s].push_back(of_problem[s]);
  }
  EXPECT_THAT(ratios[0], ElementsAre(1, 4, kInfinity));
  EXPECT_THAT(ratios[1], ElementsAre(2, 1, 1));
  EXPECT_DOUBLE_EQ(share_within(ratios[0], 1), 1.0 / 3);
  EXPECT_DOUBLE_EQ(share_within(ratios[0], 3.9), 1.0 / 3);
  EXPECT_DOUBLE_EQ(share_within(ratios[0], 4), 2.0 / 3);
  EXPECT_DOUBLE_EQ(share_within(ratios[1], 1), 2.0 / 3);
  EXPECT_DOUBLE_EQ(share_within(ratios[1], 2), 1);
}

TEST(Profiles, NoSolverIsTheFastestOnAProblemThatNoneSolves) {
  const std::array<Trial, 2> unsolved{{{10, false}, {20, false}}};
  EXPECT_THAT(performance_ratios(unsolved), ElementsAre(kInfinity, kInfinity));
}

TEST(Profiles, ADataProfileCountsSimplexGradients) {
  // With 7 dimensions a simplex gradient takes 8 evaluations.
  EXPECT_EQ(simplex_gradients({16, true}, 7), 2);
  EXPECT_EQ(simplex_gradients({16, false}, 7), kInfinity);
  const std::array numbers{2.0, 10.0, kInfinity, kInfinity};
  EXPECT_EQ(share_within(numbers, 1.9), 0);
  EXPECT_EQ(share_within(numbers, 2), 0.25);
  EXPECT_EQ(share_within(numbers, 1e9), 0.5);
}

TEST(Profiles, QuartilesInterpolate) {
  EXPECT_FALSE(quartiles({}));
  const auto found = quartiles({4, 1, 3, 2});
  EXPECT_EQ(found->lower, 1.75);
  EXPECT_EQ(found->median, 2.5);
  EXPECT_EQ(found->upper, 3.25);
}

TEST(Profiles, PlacesGrowByEqualFactorsAndEndWhereTheDataEnds) {
  const std::vector<double> places = geometric_places(1, 16, 5);
  ASSERT_EQ(places.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(places[i], std::pow(2, i), 1e-12);
  EXPECT_EQ(places.back(), 16);
  EXPECT_THAT(geometric_places(3, 3, 5), ElementsAre(3));
}

}  // namespace
}  // namespace hypotrack
