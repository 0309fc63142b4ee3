#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "lab/report/statistics/power.hpp"
#include "lab/report/statistics/significance.hpp"

namespace hypotrack {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

using Numbers = std::vector<double>;

// Hollander and Wolfe, Nonparametric Statistical Methods (1973), p. 29: depression scale of nine
// patients at two visits; V = 40, one-sided p = 0.01953.
const Numbers kFirstVisit{1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
const Numbers kSecondVisit{0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};

TEST(SignedRankTest, GivesTheTextbooksProbability) {
  EXPECT_NEAR(signed_rank_test(kFirstVisit, kSecondVisit), 2 * 10 / 512.0, 1e-12);
  EXPECT_NEAR(signed_rank_test(kSecondVisit, kFirstVisit), 2 * 10 / 512.0, 1e-12);
}

TEST(SignedRankTest, IsTheShareOfSignChoicesThatAreAsExtreme) {
  // Differences 1, 1, 2, -3, 4 of ranks 1.5, 1.5, 3, 4, 5; the negative ranks sum to 4, and of the
  // 32 choices the sums 0, 1.5, 1.5, 3, 3, 4 are not above that.
  const Numbers a{1, 1, 2, -3, 4};
  const Numbers b(5, 0.0);
  EXPECT_NEAR(signed_rank_test(a, b), 2 * 6 / 32.0, 1e-12);
}

TEST(SignedRankTest, LeavesOutPairsWithoutADifference) {
  const Numbers a{1, 2, 3, 4, 7, 7};
  const Numbers b{0, 0, 0, 0, 7, 7};
  EXPECT_NEAR(signed_rank_test(a, b), 2 / 16.0, 1e-12);
  EXPECT_EQ(signed_rank_test(b, b), 1);
}

TEST(SignedRankTest, ApproximatesManyPairs) {
  // 41 pairs with ranks 1 .. 41, of which every third is negative: V+ = 588 of 861,
  // z = (588 - 430.5 - 0.5) / sqrt(41 * 42 * 83 / 24) = 2.0345.
  Numbers a, b(41, 0.0);
  double positive = 0;
  for (int i = 1; i <= 41; ++i) {
    a.push_back(i % 3 == 0 ? -i : i);
    if (i % 3 != 0) positive += i;
  }
  const double z = (positive - 430.5 - 0.5) / std::sqrt(41.0 * 42 * 83 / 24);
  EXPECT_NEAR(signed_rank_test(a, b), std::erfc(z / std::sqrt(2.0)), 1e-12);
}

TEST(SignedRankTest, RefusesSamplesThatDoNotPair) {
  EXPECT_THROW(signed_rank_test(Numbers{1}, Numbers{1, 2}), std::invalid_argument);
}

// Hollander and Wolfe (1973), p. 69: permeability constants of the human chorioamnion at term and
// between 12 and 26 weeks; W = 35, one-sided p = 0.1272.
const Numbers kAtTerm{0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
const Numbers kEarlier{1.15, 0.88, 0.90, 0.74, 1.21};

TEST(RankSumTest, GivesTheTextbooksProbability) {
  EXPECT_NEAR(rank_sum_test(kAtTerm, kEarlier), 2 * 0.1272, 1e-4);
  EXPECT_NEAR(rank_sum_test(kEarlier, kAtTerm), 2 * 0.1272, 1e-4);
}

TEST(RankSumTest, IsTheShareOfChoicesThatAreAsExtreme) {
  // Ranks 1.5 and 1.5 against 3 and 4: of six choices one has the sum 3.
  EXPECT_NEAR(rank_sum_test(Numbers{1, 1}, Numbers{2, 3}), 2 / 6.0, 1e-12);
  EXPECT_EQ(rank_sum_test(Numbers{1, 1}, Numbers{1, 1}), 1);
  EXPECT_EQ(rank_sum_test(Numbers{}, Numbers{1}), 1);
}

TEST(RankSumTest, ApproximatesManyValuesCloseToTheExactResult) {
  // 20 values against 21 cross the border to the approximation; dropping one value stays exact.
  Numbers a, b;
  for (int i = 0; i < 20; ++i) a.push_back(i + 4.5);
  for (int i = 0; i < 20; ++i) b.push_back(i);
  const double exact = rank_sum_test(a, b);
  b.push_back(9.25);
  EXPECT_THAT(rank_sum_test(a, b), DoubleNear(exact, 0.01));
  EXPECT_NE(rank_sum_test(a, b), exact);
}

TEST(HolmTest, StepsDownAsInHolmsPaper) {
  EXPECT_THAT(holm(Numbers{0.01, 0.04, 0.03, 0.005}),
              ElementsAre(DoubleNear(0.03, 1e-12), DoubleNear(0.06, 1e-12), DoubleNear(0.06, 1e-12),
                          DoubleNear(0.02, 1e-12)));
  EXPECT_THAT(holm(Numbers{0.7, 0.9}), ElementsAre(1, 1));
  EXPECT_TRUE(holm({}).empty());
}

TEST(StatisticsTest, SmallestProbabilitiesAreReached) {
  EXPECT_EQ(smallest_signed_rank_p(6), signed_rank_test(Numbers{1, 2, 3, 4, 5, 6}, Numbers(6, 0.)));
  EXPECT_EQ(smallest_rank_sum_p(3, 4), rank_sum_test(Numbers{1, 2, 3}, Numbers{4, 5, 6, 7}));
  EXPECT_EQ(smallest_signed_rank_p(1), 1);
}

/// Pairs whose differences have the mean `effect` and the standard deviation 1.
std::optional<int> pairs_for(double effect, double alpha = 0.05) {
  const double spread = std::sqrt(0.5);
  return pairs_needed(Numbers{effect + spread, effect - spread}, Numbers{0, 0}, alpha);
}

TEST(PowerTest, PairsAreThoseOfATTestOverTheEfficiencyOfRanks) {
  // (1.95996 + 0.84162)^2 = 7.84888; + 1.95996^2 / 2 = 1.92073; all times pi / 3 = 1.04720.
  EXPECT_EQ(pairs_for(1), 11);    // 9.76961 * 1.04720 = 10.23
  EXPECT_EQ(pairs_for(0.5), 35);  // (31.39552 + 1.92073) * 1.04720 = 34.89
  EXPECT_EQ(pairs_for(-0.5), 35);
  EXPECT_EQ(pairs_for(0.2), 208);    // (196.222 + 1.92073) * 1.04720 = 207.50
  EXPECT_EQ(pairs_for(0.01), 1001);  // more than is told
}

TEST(PowerTest, FewerPairsThanTheExactTestCanSeparateAreNeverEnough) {
  EXPECT_EQ(pairs_for(10), 6);            // 2 / 2^6 = 0.03
  EXPECT_EQ(pairs_for(10, 0.05 / 3), 7);  // 2 / 2^7 = 0.0156
  EXPECT_EQ(fewest_pairs(0.05), 6);
  EXPECT_EQ(pairs_needed(Numbers{3, 4}, Numbers{1, 2}, 0.05), 6);  // always 2 apart
}

TEST(PowerTest, IndependentSamplesNeedAboutTwiceAsManyEach) {
  // 2 * 7.84888 / 1 + 1.92073 / 2 = 16.6581; * 1.04720 = 17.44.
  const double spread = std::sqrt(0.5);
  const Numbers a{1 + spread, 1 - spread}, b{spread, -spread};
  EXPECT_EQ(values_needed(a, b, 0.05), 18);
  EXPECT_EQ(values_needed(Numbers{9, 9.1}, Numbers{1, 1.1}, 0.05), 4);  // 2 / C(8, 4) = 0.029
}

TEST(PowerTest, NoNumberOfSeedsFindsADifferenceThatWasNotSeen) {
  EXPECT_EQ(pairs_needed(Numbers{1, 2}, Numbers{2, 1}, 0.05), std::nullopt);
  EXPECT_EQ(pairs_needed(Numbers{1}, Numbers{2}, 0.05), std::nullopt);
  EXPECT_EQ(values_needed(Numbers{1, 2}, Numbers{2, 1}, 0.05), std::nullopt);
  EXPECT_EQ(values_needed(Numbers{1, 2}, Numbers{3}, 0.05), std::nullopt);
  EXPECT_THROW(pairs_needed(Numbers{1}, Numbers{1, 2}, 0.05), std::invalid_argument);
}

}  // namespace
}  // namespace hypotrack
