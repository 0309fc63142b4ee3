#include "output/metrics/metrics.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "not_a_number.hpp"

namespace hypotrack {
namespace {

using testing::ElementsAre;
using testing::Pair;

/// One landmark at the origin, found off by so many millimetres along x; ten frames a second.
class Sequence {
 public:
  Sequence& add(double error_mm, FrameStatus status = FrameStatus::solved) {
    Eigen::Matrix3Xd estimate = Eigen::Matrix3Xd::Zero(3, 1);
    estimate(0, 0) = error_mm / 1000;
    collector_.add(frame_, 5 + frame_ / 10.0, {status}, estimate, Eigen::Matrix3Xd::Zero(3, 1));
    ++frame_;
    return *this;
  }
  Sequence& skip() {
    ++frame_;
    return *this;
  }
  Metrics metrics() const { return collector_.metrics(); }

 private:
  MetricsCollector collector_{landmark_layout(std::vector<std::string>{"ball.center"})};
  int frame_ = 0;
};

TEST(Metrics, StatisticsOfHandMadeErrors) {
  const Metrics m = Sequence().add(29).add(1).add(12).add(51).add(7).metrics();
  EXPECT_EQ(m.frames, 5);
  EXPECT_EQ(m.evaluated_frames, 5);
  EXPECT_NEAR(m.mean_error_mm, 20, 1e-9);
  EXPECT_NEAR(m.sd_error_mm, std::sqrt(327.2), 1e-9);
  EXPECT_NEAR(m.median_error_mm, 12, 1e-9);
  EXPECT_NEAR(m.p75_error_mm, 29, 1e-9);
  EXPECT_NEAR(m.p90_error_mm, 42.2, 1e-9);
  EXPECT_NEAR(m.p95_error_mm, 46.6, 1e-9);
  EXPECT_NEAR(m.max_error_mm, 51, 1e-9);
  EXPECT_NEAR(m.auc_20_50, (3 + 21.0 / 30) / 5, 1e-9);
  EXPECT_THAT(m.success, ElementsAre(0.2, 0.4, 0.6, 0.8, 0.8, 0.8));
}

TEST(Metrics, AFrameIsLostBeyond40MmOrWhenTheTrackerSaysSo) {
  const Metrics m =
      Sequence().add(10).add(39.9).add(40.1).add(5, FrameStatus::lost).add(2).metrics();
  EXPECT_EQ(m.lost_frames, 2);
  EXPECT_DOUBLE_EQ(m.lost_share, 0.4);
  EXPECT_EQ(m.frames_to_loss, 2);
  EXPECT_NEAR(m.time_to_loss_s, 0.2, 1e-12);
}

TEST(Metrics, WhatIsNeverLostHasNoTimeToLoss) {
  const Metrics m = Sequence().add(10).add(20).metrics();
  EXPECT_EQ(m.lost_frames, 0);
  EXPECT_DOUBLE_EQ(m.lost_share, 0);
  EXPECT_FALSE(m.frames_to_loss);
  EXPECT_TRUE(std::isnan(m.time_to_loss_s));
}

TEST(Metrics, EverythingLost) {
  const Metrics m = Sequence().add(100).add(200).add(300).metrics();
  EXPECT_EQ(m.lost_frames, 3);
  EXPECT_DOUBLE_EQ(m.lost_share, 1);
  EXPECT_EQ(m.frames_to_loss, 0);
  EXPECT_DOUBLE_EQ(m.time_to_loss_s, 0);
  EXPECT_DOUBLE_EQ(m.auc_20_50, 0);
  EXPECT_DOUBLE_EQ(m.success_curve.back(), 0);
}

TEST(Metrics, MissingFramesAreCountedAndLeftOut) {
  const Metrics m = Sequence().add(10).add(500, FrameStatus::missing).add(20).add(45).metrics();
  EXPECT_EQ(m.frames, 4);
  EXPECT_EQ(m.missing_frames, 1);
  EXPECT_EQ(m.evaluated_frames, 3);
  EXPECT_NEAR(m.mean_error_mm, 25, 1e-9);
  EXPECT_EQ(m.lost_frames, 1);
  EXPECT_DOUBLE_EQ(m.lost_share, 1.0 / 3);
  EXPECT_EQ(m.frames_to_loss, 3);
}

TEST(Metrics, OneFrameHasNoJitter) {
  const Metrics m = Sequence().add(8).metrics();
  EXPECT_NEAR(m.mean_error_mm, 8, 1e-9);
  EXPECT_DOUBLE_EQ(m.sd_error_mm, 0);
  EXPECT_NEAR(m.p95_error_mm, 8, 1e-9);
  EXPECT_TRUE(std::isnan(m.jitter_mm));
}

TEST(Metrics, NothingAtAllIsUnknown) {
  const Metrics m = Sequence().metrics();
  EXPECT_EQ(m.frames, 0);
  EXPECT_TRUE(std::isnan(m.mean_error_mm));
  EXPECT_TRUE(std::isnan(m.lost_share));
  EXPECT_TRUE(std::isnan(m.success[0]));
  EXPECT_THAT(m.models, ElementsAre(Pair("ball", testing::IsNan())));
  EXPECT_THAT(m.landmarks, ElementsAre(Pair("ball.center", testing::IsNan())));
}

TEST(Metrics, JitterIsTheMeanSecondDifferenceOfTheError) {
  // 1 - 2 * 0 + 0 = 1; 0 - 2 * 1 + 0 = -2; 3 - 0 + 1 = 4
  EXPECT_NEAR(Sequence().add(0).add(0).add(1).add(0).add(3).metrics().jitter_mm, 7.0 / 3, 1e-9);
}

TEST(Metrics, ASteadyOrSteadilyGrowingErrorIsNoJitter) {
  EXPECT_NEAR(Sequence().add(9).add(9).add(9).metrics().jitter_mm, 0, 1e-9);
  EXPECT_NEAR(Sequence().add(3).add(6).add(9).add(12).metrics().jitter_mm, 0, 1e-9);
}

TEST(Metrics, JitterNeedsThreeFramesInARow) {
  EXPECT_TRUE(std::isnan(Sequence().add(0).add(9).skip().add(0).add(9).metrics().jitter_mm));
  const Metrics missing =
      Sequence().add(0).add(9).add(4, FrameStatus::missing).add(0).add(9).metrics();
  EXPECT_TRUE(std::isnan(missing.jitter_mm));
  EXPECT_NEAR(Sequence().add(7).skip().add(0).add(0).add(2).metrics().jitter_mm, 2, 1e-9);
}

TEST(Metrics, TrueMotionIsNoJitter) {
  MetricsCollector collector(landmark_layout(std::vector<std::string>{"ball.center"}));
  for (int i = 0; i < 5; ++i) {
    const Eigen::Matrix3Xd truth = Eigen::Matrix3Xd::Constant(3, 1, 0.1 * i * i);
    collector.add(i, i, {}, truth.array() + 0.002, truth);
  }
  EXPECT_NEAR(collector.metrics().jitter_mm, 0, 1e-9);
}

TEST(Metrics, MeansOfModelsAndLandmarksAreOverTheFramesThatKnowThem) {
  MetricsCollector collector(
      landmark_layout(std::vector<std::string>{"hand.wrist", "hand.tip", "box.center"}));
  Eigen::Matrix3Xd truth = Eigen::Matrix3Xd::Zero(3, 3);
  Eigen::Matrix3Xd estimate = truth;
  estimate.row(2) << 0.002, 0.004, 0.010;
  collector.add(0, 0, {}, estimate, truth);
  truth.col(1).setConstant(test::kNan);
  truth.col(2).setConstant(test::kNan);
  estimate.row(2) << 0.006, 0.004, 0.010;
  collector.add(1, 0, {}, estimate, truth);
  collector.add(2, 0, {}, estimate, {});
  const Metrics m = collector.metrics();
  EXPECT_EQ(m.frames, 3);
  EXPECT_EQ(m.evaluated_frames, 2);
  EXPECT_NEAR(m.mean_error_mm, (6.5 + 6) / 2, 1e-9);
  const auto about = [](double value) { return testing::DoubleNear(value, 1e-9); };
  EXPECT_THAT(m.models, ElementsAre(Pair("hand", about(4.5)), Pair("box", about(10))));
  EXPECT_THAT(m.landmarks, ElementsAre(Pair("hand.wrist", about(4)), Pair("hand.tip", about(4)),
                                       Pair("box.center", about(10))));
}

}  // namespace
}  // namespace hypotrack
