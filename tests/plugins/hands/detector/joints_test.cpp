#include <gtest/gtest.h>

#include <string>

#include "hand_detection.hpp"
#include "pictures.hpp"
#include "upright_hand.hpp"

namespace hypotrack::hands {
namespace {

TEST(HandJoints, OfTipsAndWristLieFurtherOutThanTheLandmarks) {
  const HandPoints landmarks = test::upright_hand(), joints = joints_of(landmarks);
  EXPECT_GT(joints(1, 0), landmarks(1, 0)) << "wrist";
  for (const Eigen::Index tip : {4, 8, 12, 16, 20})
    EXPECT_LT(joints(1, tip), landmarks(1, tip)) << tip;
  for (const Eigen::Index knuckle : {5, 9, 13, 17})
    EXPECT_EQ(joints.col(knuckle), landmarks.col(knuckle)) << knuckle;
}

TEST(HandJoints, AreUndoneByLandmarksAt) {
  const HandPoints landmarks = test::upright_hand();
  EXPECT_TRUE(landmarks_at(joints_of(landmarks)).isApprox(landmarks, 1e-12));
}

TEST(HandJoints, MoveAndGrowWithTheHand) {
  const HandPoints landmarks = test::upright_hand();
  const Eigen::Vector2d shift(7, -3);
  const HandPoints moved = (2.5 * landmarks).colwise() + shift;
  const HandPoints expected = (2.5 * joints_of(landmarks)).colwise() + shift;
  EXPECT_TRUE(joints_of(moved).isApprox(expected, 1e-12));
}

TEST(HandJoints, OfARenderedHandAreNearerToItsJointsThanTheLandmarks) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const auto pictures = test::rendered_hand();
  const HandPoints truth = test::true_points(pictures);
  const HandPoints joints = test::only_hand(detector, pictures.picture()).landmarks;
  const double of_joints = test::mean_distance(joints, truth);
  const double of_landmarks = test::mean_distance(landmarks_at(joints), truth);
  RecordProperty("of_joints", std::to_string(of_joints));
  RecordProperty("of_landmarks", std::to_string(of_landmarks));
  EXPECT_LT(of_joints, of_landmarks);
}

}  // namespace
}  // namespace hypotrack::hands
