#include "output/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "test_models.hpp"

namespace hypotrack {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Metrics, TheErrorIsTheMeanOverLandmarksThenOverModels) {
  const Scene scene({{"hand", std::make_shared<Model>(test::make_test_hand())},
                     {"box", std::make_shared<Model>(test::make_test_box())}});
  const Eigen::Matrix3Xd truth = scene.landmarks(scene.rest_state());
  Eigen::Matrix3Xd off = truth;
  off.leftCols(21).row(0).array() += 0.002;  // the hand's 21 joints by 2 mm
  off.rightCols(3).row(1).array() += 0.006;  // the box's 3 anchors by 6 mm
  EXPECT_NEAR(mean_landmark_error(scene, off, truth), 0.004, 1e-12);
}

TEST(Metrics, UnknownLandmarksAreLeftOut) {
  const Scene scene({{"hand", std::make_shared<Model>(test::make_test_hand())},
                     {"box", std::make_shared<Model>(test::make_test_box())}});
  Eigen::Matrix3Xd truth = scene.landmarks(scene.rest_state());
  Eigen::Matrix3Xd off = truth;
  off.col(4).x() += 0.010;
  truth.leftCols(21).setConstant(kNan);
  truth.col(4) = off.col(4) - Eigen::Vector3d(0.003, 0, 0);
  truth.rightCols(3).setConstant(kNan);
  EXPECT_NEAR(mean_landmark_error(scene, off, truth), 0.003, 1e-12);
  truth.setConstant(kNan);
  EXPECT_TRUE(std::isnan(mean_landmark_error(scene, off, truth)));
}

TEST(Metrics, StatisticsOfHandMadeErrors) {
  const auto s = error_statistics({0.001, 0.030, kNan, 0.007, 0.012, 0.050});
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->mean, 20, 1e-9);
  EXPECT_NEAR(s->median, 12, 1e-9);
  EXPECT_NEAR(s->fraction_below[0], 0.2, 1e-12);
  EXPECT_NEAR(s->fraction_below[1], 0.4, 1e-12);
  EXPECT_NEAR(s->fraction_below[2], 0.6, 1e-12);
  EXPECT_NEAR(s->fraction_below[3], 0.8, 1e-12);
}

TEST(Metrics, AnEvenNumberOfErrorsHasTheMiddleTwoAveragedAsMedian) {
  EXPECT_NEAR(error_statistics({0.004, 0.001, 0.002, 0.009})->median, 3, 1e-9);
}

TEST(Metrics, ARunWithoutTruthHasNoStatistics) {
  EXPECT_FALSE(error_statistics({kNan, kNan}));
  EXPECT_FALSE(error_statistics({}));
}

TEST(Metrics, TheTrueStateGivesTheTrueLandmarks) {
  const Scene scene({{"box", std::make_shared<Model>(test::make_test_box())}});
  Frame frame;
  EXPECT_FALSE(true_landmarks(scene, frame));
  frame.truth = GroundTruth{scene.rest_state(), {}};
  EXPECT_EQ(*true_landmarks(scene, frame), scene.landmarks(scene.rest_state()));
  frame.truth->landmarks = Eigen::Matrix3Xd::Ones(3, 3);
  EXPECT_EQ(*true_landmarks(scene, frame), Eigen::Matrix3Xd::Ones(3, 3));
}

}  // namespace
}  // namespace hypotrack
