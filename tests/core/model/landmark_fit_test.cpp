#include "hypotrack/plugin/landmark_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/params.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

const Model& hand() {
  static const Model model(test::make_test_hand());
  return model;
}

Scene hand_scene() { return Scene({{"hand", std::make_shared<Model>(test::make_test_hand())}}); }

/// A state with angles in the middle half of their ranges.
Eigen::VectorXd some_pose(std::mt19937_64& random) {
  static const Scene scene = hand_scene();
  Eigen::VectorXd state = test::random_state(scene, random);
  for (Eigen::Index i = 7; i < state.size(); ++i) {
    const Parameter& p = scene.parameters()[static_cast<std::size_t>(i)];
    state[i] = 0.5 * state[i] + 0.25 * (p.lower + p.upper);
  }
  return state;
}

TEST(LandmarkFit, FindsPosesFromLandmarksAlone) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::VectorXd truth = some_pose(random);
    const Eigen::Matrix3Xd landmarks = posed_landmarks(hand(), test::values_of(truth));
    const Eigen::VectorXd rest = hand_scene().rest_state();
    const Eigen::VectorXd start = align_to_landmarks(hand(), landmarks, test::values_of(rest));
    const LandmarkFit fit = fit_landmarks(hand(), landmarks, test::values_of(start));
    EXPECT_LT(fit.mean_distance, 0.6e-3) << trial;
    EXPECT_LT(fit.max_distance, 2e-3) << trial;
    EXPECT_NEAR(fit.parameters.segment<4>(3).norm(), 1, 1e-12);
    EXPECT_EQ(fit.scale, 1);
    const Eigen::Matrix3Xd posed = posed_landmarks(hand(), test::values_of(fit.parameters));
    EXPECT_NEAR((posed - landmarks).colwise().norm().mean(), fit.mean_distance, 1e-9);
  }
}

TEST(LandmarkFit, FindsTheSizeTooIfAsked) {
  std::mt19937_64 random(4);
  const Eigen::VectorXd truth = some_pose(random);
  const Eigen::Vector3d position = truth.head<3>();
  Eigen::Matrix3Xd landmarks = posed_landmarks(hand(), test::values_of(truth));
  landmarks = (0.9 * (landmarks.colwise() - position)).colwise() + position;
  const LandmarkFit fit = fit_landmarks(hand(), landmarks, test::values_of(truth), {.scale = true});
  EXPECT_NEAR(fit.scale, 0.9, 0.002);
  EXPECT_LT(fit.mean_distance, 0.6e-3);
  EXPECT_GT(fit_landmarks(hand(), landmarks, test::values_of(truth)).mean_distance, 1.5e-3);
}

TEST(LandmarkFit, PassesOverUnknownLandmarks) {
  std::mt19937_64 random(5);
  const Eigen::VectorXd truth = some_pose(random);
  const Eigen::Matrix3Xd landmarks = posed_landmarks(hand(), test::values_of(truth));
  Eigen::Matrix3Xd some = landmarks;
  some(1, 8) = std::numeric_limits<double>::quiet_NaN();
  some.col(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  const LandmarkFit fit = fit_landmarks(hand(), some, test::values_of(truth));
  EXPECT_LT(fit.mean_distance, 0.6e-3);
  EXPECT_TRUE(fit.parameters.allFinite());
}

TEST(LandmarkFit, LeavesWhatNoLandmarkDeterminesAtThePrior) {
  std::mt19937_64 random(8);
  const Eigen::VectorXd truth = some_pose(random);
  Eigen::Matrix3Xd landmarks = posed_landmarks(hand(), test::values_of(truth));
  landmarks.rightCols(4).setConstant(std::numeric_limits<double>::quiet_NaN());  // a whole finger
  const Eigen::VectorXd rest = hand_scene().rest_state();
  const LandmarkFit free = fit_landmarks(hand(), landmarks, test::values_of(truth));
  EXPECT_LT((free.parameters - rest).tail(4).norm(), 1e-6);
  const LandmarkFit led =
      fit_landmarks(hand(), landmarks, test::values_of(rest), {.prior = test::values_of(truth)});
  EXPECT_LT((led.parameters - truth).tail(4).norm(), 1e-6);
  EXPECT_LT(led.mean_distance, free.mean_distance);
}

TEST(LandmarkFit, KeepsAnglesWithinTheirBounds) {
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::VectorXd truth = some_pose(random);
    Eigen::Matrix3Xd landmarks = posed_landmarks(hand(), test::values_of(truth));
    std::normal_distribution<double> noise(0, 0.02);
    for (double& v : landmarks.reshaped()) v += noise(random);
    const LandmarkFit fit = fit_landmarks(hand(), landmarks, test::values_of(truth));
    EXPECT_NO_THROW(hand_scene().check(fit.parameters, "fit")) << trial;
    EXPECT_GT(fit.mean_distance, 2e-3);
  }
}

TEST(LandmarkFit, RefusesWhatSaysNothing) {
  const Eigen::VectorXd rest = hand_scene().rest_state();
  Eigen::Matrix3Xd landmarks(3, 21);
  landmarks.setConstant(std::numeric_limits<double>::quiet_NaN());
  landmarks.leftCols(2).setZero();
  EXPECT_THAT(
      test::message_of<DataError>([&] { fit_landmarks(hand(), landmarks, test::values_of(rest)); }),
      testing::HasSubstr("2 known landmarks do not say"));
  EXPECT_THAT(test::message_of<DataError>([&] {
                align_to_landmarks(hand(), landmarks.leftCols(5), test::values_of(rest));
              }),
              testing::HasSubstr("5 landmarks were given to a model that has 21"));
}

TEST(LandmarkFit, AlignsAPoseAsARigidBody) {
  std::mt19937_64 random(7);
  const Eigen::VectorXd truth = some_pose(random);
  Eigen::VectorXd elsewhere = truth;
  elsewhere.head<7>() = hand_scene().rest_state().head<7>();
  const Eigen::VectorXd placed = align_to_landmarks(
      hand(), posed_landmarks(hand(), test::values_of(truth)), test::values_of(elsewhere));
  EXPECT_LT((placed.head<3>() - truth.head<3>()).norm(), 1e-9);
  EXPECT_NEAR(std::abs(placed.segment<4>(3).dot(truth.segment<4>(3))), 1, 1e-9);
  EXPECT_EQ(placed.tail(20), truth.tail(20));
}

}  // namespace
}  // namespace hypotrack
