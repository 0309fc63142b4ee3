#include "output/metrics/landmark_errors.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "not_a_number.hpp"

namespace hypotrack {
namespace {

using testing::ElementsAre;

LandmarkLayout hand_and_box_layout() {
  return landmark_layout(std::vector<std::string>{"hand.wrist", "hand.index_tip", "box.center",
                                                  "box.end_x", "box.end_z"});
}

/// Off by 2 and 4 along the hand's two landmarks, by 9 at every anchor of the box.
Eigen::Matrix3Xd off(const Eigen::Matrix3Xd& truth) {
  Eigen::Matrix3Xd estimate = truth;
  estimate(0, 0) += 2;
  estimate(1, 1) -= 4;
  for (int i = 2; i < 5; ++i) estimate.col(i) += Eigen::Vector3d(1, 4, 8);
  return estimate;
}

TEST(LandmarkErrors, WhatStandsBeforeTheDotIsTheModel) {
  const LandmarkLayout layout = hand_and_box_layout();
  EXPECT_THAT(layout.models, ElementsAre("hand", "box"));
  EXPECT_THAT(layout.model_of, ElementsAre(0, 0, 1, 1, 1));
  EXPECT_THAT(landmark_layout(std::vector<std::string>{"wrist"}).models, ElementsAre("model"));
}

TEST(LandmarkErrors, LandmarksAreAveragedPerModelThenOverModels) {
  const Eigen::Matrix3Xd truth = Eigen::Matrix3Xd::Constant(3, 5, 7);
  const FrameError error = frame_error(hand_and_box_layout(), off(truth), truth);
  EXPECT_THAT(error.landmarks, ElementsAre(2, 4, 9, 9, 9));
  EXPECT_THAT(error.models, ElementsAre(3, 9));
  EXPECT_DOUBLE_EQ(error.mean, 6);  // not 33 / 5, the mean over landmarks
}

TEST(LandmarkErrors, UnknownLandmarksAreLeftOutOnEitherSide) {
  Eigen::Matrix3Xd truth = Eigen::Matrix3Xd::Constant(3, 5, 7);
  Eigen::Matrix3Xd estimate = off(truth);
  truth.col(0).setConstant(test::kNan);
  estimate.col(4).setConstant(test::kNan);
  const FrameError error = frame_error(hand_and_box_layout(), estimate, truth);
  EXPECT_TRUE(std::isnan(error.landmarks[0]));
  EXPECT_THAT(error.models, ElementsAre(4, 9));
  EXPECT_DOUBLE_EQ(error.mean, 6.5);
}

TEST(LandmarkErrors, AModelWithoutAnyTruthCountsForNothing) {
  Eigen::Matrix3Xd truth = Eigen::Matrix3Xd::Constant(3, 5, 7);
  const Eigen::Matrix3Xd estimate = off(truth);
  truth.rightCols(3).setConstant(test::kNan);
  const FrameError error = frame_error(hand_and_box_layout(), estimate, truth);
  EXPECT_DOUBLE_EQ(error.models[0], 3);
  EXPECT_TRUE(std::isnan(error.models[1]));
  EXPECT_DOUBLE_EQ(error.mean, 3);
}

TEST(LandmarkErrors, WithoutTruthThereIsNoError) {
  const Eigen::Matrix3Xd estimate = Eigen::Matrix3Xd::Zero(3, 5);
  const Eigen::Matrix3Xd unknown = Eigen::Matrix3Xd::Constant(3, 5, test::kNan);
  for (const Eigen::Matrix3Xd& truth : {Eigen::Matrix3Xd(), unknown}) {
    const FrameError error = frame_error(hand_and_box_layout(), estimate, truth);
    EXPECT_TRUE(std::isnan(error.mean));
    EXPECT_EQ(error.landmarks.size(), 5);
    EXPECT_EQ(error.models.size(), 2U);
  }
}

}  // namespace
}  // namespace hypotrack
