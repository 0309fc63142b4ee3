#include "output/metrics/reliability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace hypotrack {
namespace {

TEST(Reliability, IsOneWhereErrorsAreAsLargeAsTheSigmasSay) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Reliability reliability;
  for (int i = 0; i < 20000; ++i) {
    const double sigma = 0.001 * (1 + i % 30);
    reliability.add(Eigen::VectorXd::Constant(1, sigma),
                    Eigen::VectorXd::Constant(1, std::abs(sigma * normal(random))));
  }
  EXPECT_NEAR(reliability.error_over_sigma(), 1, 0.02);
  EXPECT_NEAR(reliability.within(1), 0.683, 0.01);
  EXPECT_NEAR(reliability.within(2), 0.954, 0.01);
  EXPECT_NEAR(reliability.within(3), 0.997, 0.002);
  for (const ReliabilityBin& bin : reliability.bins()) {
    if (bin.count == 0) continue;
    EXPECT_NEAR(bin.error / bin.sigma, 1, 0.1) << bin.low;
  }
}

TEST(Reliability, SortsLandmarksBySigma) {
  Reliability reliability;
  Eigen::VectorXd sigma(5), error(5);
  sigma << 0.0004, 0.0005, 0.003, 0.0039, 5;
  error << 0.001, 0.002, 0.003, 0.005, 0.1;
  reliability.add(sigma, error);
  const auto bins = reliability.bins();
  EXPECT_EQ(bins[0].count, 1);
  EXPECT_EQ(bins[1].count, 1);
  EXPECT_EQ(bins[3].count, 2);
  EXPECT_DOUBLE_EQ(bins[3].low, 0.002);
  EXPECT_DOUBLE_EQ(bins[3].high, 0.004);
  EXPECT_NEAR(bins[3].error, std::sqrt((9e-6 + 25e-6) / 2), 1e-12);
  EXPECT_EQ(bins.back().count, 1);
  EXPECT_EQ(reliability.count(), 5);
}

TEST(Reliability, LeavesOutWhatIsUnknown) {
  Reliability reliability;
  EXPECT_TRUE(std::isnan(reliability.error_over_sigma()));
  EXPECT_TRUE(std::isnan(reliability.within(1)));
  Eigen::VectorXd sigma(3), error(3);
  sigma << std::numeric_limits<double>::infinity(), 0.01, 0.01;
  error << 0.01, std::numeric_limits<double>::quiet_NaN(), 0.005;
  reliability.add(sigma, error);
  EXPECT_EQ(reliability.count(), 1);
  EXPECT_DOUBLE_EQ(reliability.error_over_sigma(), 0.5);
  EXPECT_DOUBLE_EQ(reliability.within(1), 1);
}

}  // namespace
}  // namespace hypotrack
