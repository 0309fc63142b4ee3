// Pictures that are turned, mirrored and shifted; hands that have moved since the last frame.
#include <opencv2/core.hpp>
#include <random>

#include "pictures.hpp"

namespace hypotrack {
namespace {

/// The points with x and y exchanged and counted from the other edge, as asked.
HandPoints placed(const HandPoints& p, bool exchange, double from_right, double from_bottom) {
  HandPoints out = p;
  if (exchange) out.row(0).swap(out.row(1));
  if (from_right > 0) out.row(0) = (from_right - 1 - out.row(0).array()).matrix();
  if (from_bottom > 0) out.row(1) = (from_bottom - 1 - out.row(1).array()).matrix();
  return out;
}

TEST(MovedPicture, TurnedTurnsTheLandmarks) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const cv::Mat picture = test::rendered_hand().picture();
  const HandPoints points = test::only_hand(detector, picture).landmarks;
  const auto distance_when = [&](cv::RotateFlags turn, const HandPoints& expected) {
    cv::Mat turned;
    cv::rotate(picture, turned, turn);
    const HandDetection hand = test::only_hand(detector, turned);
    EXPECT_GT(hand.right, 0.5);
    return test::mean_distance(hand.landmarks, expected);
  };
  const double w = picture.cols, h = picture.rows;
  EXPECT_LT(distance_when(cv::ROTATE_90_CLOCKWISE, placed(points, true, h, 0)), 4);
  EXPECT_LT(distance_when(cv::ROTATE_180, placed(points, false, w, h)), 4);
  EXPECT_LT(distance_when(cv::ROTATE_90_COUNTERCLOCKWISE, placed(points, true, 0, w)), 4);
}

TEST(MovedPicture, MirroredChangesTheHandedness) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const cv::Mat picture = test::rendered_hand().picture();
  cv::Mat mirrored;
  cv::flip(picture, mirrored, 1);
  const HandDetection right = test::only_hand(detector, picture);
  const HandDetection left = test::only_hand(detector, mirrored);
  EXPECT_GT(right.right, 0.8);
  EXPECT_LT(left.right, 0.2);
  EXPECT_LT(test::mean_distance(left.landmarks, placed(right.landmarks, false, picture.cols, 0)),
            8);
}

TEST(MovedPicture, ShiftedShiftsTheLandmarks) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const cv::Mat picture = test::rendered_hand().picture();
  const cv::Rect part(301, 77, 800, 600);
  HandPoints points = test::only_hand(detector, picture).landmarks;
  points.colwise() -= Eigen::Vector2d(part.x, part.y);
  const HandDetection hand = test::only_hand(detector, picture(part));
  EXPECT_LT(test::mean_distance(hand.landmarks, points), 4);
}

TEST(Refinement, OfNoisyLandmarksFindsTheSameHand) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const cv::Mat picture = test::rendered_hand().picture();
  const HandPoints points = test::only_hand(detector, picture).landmarks;
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 8);
  for (int i = 0; i < 5; ++i) {
    const HandPoints guess =
        points + HandPoints::NullaryExpr([&](Eigen::Index, Eigen::Index) { return noise(random); });
    const auto hand = detector.refine(picture, guess);
    ASSERT_TRUE(hand);
    EXPECT_LT(test::mean_distance(hand->landmarks, points), 4);
    EXPECT_EQ(hand->palm_score, 1);
  }
}

TEST(Refinement, FollowsAHandThatHasMoved) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const cv::Mat picture = test::rendered_hand().picture();
  const HandPoints points = test::only_hand(detector, picture).landmarks;
  HandPoints guess = points;
  guess.colwise() += Eigen::Vector2d(40, -30);
  const auto hand = detector.refine(picture, guess);
  ASSERT_TRUE(hand);
  EXPECT_LT(test::mean_distance(hand->landmarks, points), 6);
}

TEST(Refinement, FindsNothingWhereNoHandIs) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const auto pictures = test::rendered_hand();
  const HandPoints points = test::true_points(pictures);
  HandPoints guess = points;
  guess.colwise() -= Eigen::Vector2d(500, 0);
  EXPECT_FALSE(detector.refine(pictures.picture(), guess));
  guess.colwise() -= Eigen::Vector2d(1e9, 0);
  EXPECT_FALSE(detector.refine(pictures.picture(), guess)) << "far outside the picture";
  guess = points;
  guess(0, 3) = NAN;
  EXPECT_FALSE(detector.refine(pictures.picture(), guess)) << "a point behind the camera";
  EXPECT_FALSE(detector.refine(pictures.picture(), HandPoints::Zero())) << "no size";
}

}  // namespace
}  // namespace hypotrack
