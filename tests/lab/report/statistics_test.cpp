#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "lab/report/significance.hpp"

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

}  // namespace
}  // namespace hypotrack
