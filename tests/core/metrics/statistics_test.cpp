#include "base/statistics.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "hypotrack/plugin/numbers.hpp"
#include "not_a_number.hpp"

namespace hypotrack {
namespace {

using testing::ElementsAre;

const std::vector<double> kErrors = {30, 1, 12, 50, 7};  // 1 7 12 30 50
const std::vector<double> kNone;

TEST(Statistics, NanIsLeftOutAndTheOrderStays) {
  EXPECT_THAT(without_nan(std::vector<double>{test::kNan, 3, 1, test::kNan}), ElementsAre(3, 1));
}

TEST(Statistics, MeanAndStandardDeviation) {
  EXPECT_DOUBLE_EQ(mean(kErrors), 20);
  // (100 + 361 + 64 + 900 + 169) / 5 = 318.8
  EXPECT_DOUBLE_EQ(standard_deviation(kErrors), std::sqrt(318.8));
  EXPECT_DOUBLE_EQ(standard_deviation(std::vector<double>{4}), 0);
}

TEST(Statistics, ASampleDeviationDividesByOneLess) {
  EXPECT_NEAR(sample_deviation(std::vector<double>{2, 4, 4, 4, 5, 5, 7, 9}), std::sqrt(32 / 7.0),
              1e-12);
  EXPECT_TRUE(std::isnan(sample_deviation(std::vector<double>{1})));
}

TEST(Statistics, TheUpperMedianIsOneOfTheValues) {
  EXPECT_EQ(upper_median(std::vector{5, 1, 9}), 5);
  EXPECT_EQ(upper_median(std::vector{7.5, 1.0, 3.0, 9.0}), 7.5);
  EXPECT_EQ(upper_median(std::vector{2.5f}), 2.5f);
}

TEST(Statistics, PercentilesAreLinearBetweenNeighbours) {
  EXPECT_DOUBLE_EQ(percentile(kErrors, 0), 1);
  EXPECT_DOUBLE_EQ(percentile(kErrors, 0.5), 12);
  EXPECT_DOUBLE_EQ(percentile(kErrors, 0.75), 30);
  EXPECT_DOUBLE_EQ(percentile(kErrors, 0.9), 42);  // position 3.6: 30 + 0.6 * 20
  EXPECT_DOUBLE_EQ(percentile(kErrors, 1), 50);
  EXPECT_DOUBLE_EQ(percentile(std::vector<double>{4, 1, 2, 9}, 0.5), 3);
  EXPECT_DOUBLE_EQ(percentile(std::vector<double>{8}, 0.95), 8);
}

TEST(Statistics, AnErrorAtTheThresholdIsNotBelowIt) {
  EXPECT_DOUBLE_EQ(share_below(kErrors, 12), 0.4);
  EXPECT_DOUBLE_EQ(share_below(kErrors, 12.001), 0.6);
  EXPECT_DOUBLE_EQ(share_below(kErrors, 0), 0);
  EXPECT_DOUBLE_EQ(share_below(kErrors, 1000), 1);
}

TEST(Statistics, TheCurveHasAPointForEveryMillimetreTo100) {
  const auto curve = success_curve(kErrors);
  EXPECT_DOUBLE_EQ(curve[1], 0);
  EXPECT_DOUBLE_EQ(curve[2], 0.2);
  EXPECT_DOUBLE_EQ(curve[30], 0.6);
  EXPECT_DOUBLE_EQ(curve[31], 0.8);
  EXPECT_DOUBLE_EQ(curve[51], 1);
  EXPECT_DOUBLE_EQ(curve.back(), 1);
  for (std::size_t i = 1; i < curve.size(); ++i) EXPECT_GE(curve[i], curve[i - 1]);
}

TEST(Statistics, TheAreaIsThatUnderTheCurveBetweenItsEnds) {
  EXPECT_DOUBLE_EQ(area_under_success(std::vector<double>{35}, 20, 50), 0.5);
  EXPECT_DOUBLE_EQ(area_under_success(std::vector<double>{3, 20}, 20, 50), 1);
  EXPECT_DOUBLE_EQ(area_under_success(std::vector<double>{50, 400}, 20, 50), 0);
  // 1, 7 and 12 give 1 each, 30 gives 20 / 30, 50 gives 0.
  EXPECT_DOUBLE_EQ(area_under_success(kErrors, 20, 50), (3 + 20.0 / 30) / 5);
}

TEST(Statistics, TheAreaIsWhatAFineSumOverTheCurveTendsTo) {
  constexpr int kSteps = 30000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += share_below(kErrors, 20 + 30 * (i + 0.5) / kSteps);
  EXPECT_NEAR(area_under_success(kErrors, 20, 50), sum / kSteps, 1e-4);
}

TEST(Statistics, OfNothingEverythingIsUnknown) {
  EXPECT_TRUE(std::isnan(mean(kNone)));
  EXPECT_TRUE(std::isnan(standard_deviation(kNone)));
  EXPECT_TRUE(std::isnan(percentile(kNone, 0.5)));
  EXPECT_TRUE(std::isnan(share_below(kNone, 10)));
  EXPECT_TRUE(std::isnan(area_under_success(kNone, 20, 50)));
  EXPECT_TRUE(std::isnan(success_curve(kNone)[40]));
}

}  // namespace
}  // namespace hypotrack
