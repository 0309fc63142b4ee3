// The hand that comes with hypotrack, rendered.
#include <opencv2/imgproc.hpp>

#include "pictures.hpp"

namespace hypotrack {
namespace {

TEST(RenderedHand, IsFoundNearItsLandmarksInBothViews) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const auto pictures = test::rendered_hand();
  for (std::size_t view = 0; view < 2; ++view) {
    const HandDetection hand = test::only_hand(detector, pictures.picture(view));
    const HandPoints truth = test::true_points(pictures, view);
    RecordProperty("distance", std::to_string(test::mean_distance(hand.landmarks, truth)));
    EXPECT_LT(test::mean_distance(hand.landmarks, truth), 12) << "pixels, of a hand of 300";
    EXPECT_GT(hand.right, 0.5);
    EXPECT_GT(hand.palm_score, 0.5);
  }
}

TEST(RenderedHand, IsFoundByTheLiteNetworks) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({.lite = true});
  const auto pictures = test::rendered_hand();
  const HandDetection hand = test::only_hand(detector, pictures.picture());
  EXPECT_LT(test::mean_distance(hand.landmarks, test::true_points(pictures)), 15);
}

TEST(RenderedHand, HasTheRelativeShapeOfItsLandmarksInThePicture) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  cv::Mat picture;
  // Turned, so that the axes of the picture are not those of the hand.
  cv::rotate(test::rendered_hand().picture(), picture, cv::ROTATE_90_CLOCKWISE);
  const HandDetection hand = test::only_hand(detector, picture);
  const Eigen::Matrix<double, 2, 21> flat = hand.relative.topRows<2>();
  const Eigen::Vector2d in_space = flat.col(12) - flat.col(0);
  const Eigen::Vector2d in_picture = hand.landmarks.col(12) - hand.landmarks.col(0);
  EXPECT_GT(in_space.normalized().dot(in_picture.normalized()), 0.98);
  EXPECT_NEAR((hand.relative.col(12) - hand.relative.col(0)).norm(), 0.17, 0.04) << "metres";
}

const cv::Rect kAround(560, 180, 280, 320);  // of test::rendered_hand(), the hand

/// Returns a large picture with a rendered hand whose size is changed.
cv::Mat with_small_hand(const cv::Mat& hand, double scale, const cv::Point& at) {
  cv::Mat small, picture(720, 1280, CV_8UC3, cv::Scalar(90, 100, 110));
  cv::resize(hand(kAround), small, {}, scale, scale, cv::INTER_AREA);
  small.copyTo(picture(cv::Rect(at, small.size())));
  return picture;
}

/// Returns in how many turns of all tiles a glance finds one hand.
int turns_that_find(const HandDetector& detector, const cv::Mat& picture) {
  constexpr int kTiles = 6;  // half as large as the picture is wide
  int out = 0;
  for (int turn = 0; turn < kTiles; ++turn) out += detector.glance(picture, turn).size() == 1;
  return out;
}

TEST(RenderedHand, OfFiftyPixelsIsFoundInALargePictureWhereThoroughlyLookedFor) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const auto pictures = test::rendered_hand();
  constexpr double kScale = 1 / 5.0;
  const cv::Point at(900, 500);
  const cv::Mat picture = with_small_hand(pictures.picture(), kScale, at);

  EXPECT_EQ(turns_that_find(detector, picture), 0);
  const HandDetection hand = test::only_hand(detector, picture);
  HandPoints truth = test::true_points(pictures);
  truth.row(0) = kScale * (truth.row(0).array() + 0.5 - kAround.x) - 0.5 + at.x;
  truth.row(1) = kScale * (truth.row(1).array() + 0.5 - kAround.y) - 0.5 + at.y;
  EXPECT_LT(test::mean_distance(hand.landmarks, truth), 5);
}

TEST(RenderedHand, OfHundredPixelsIsFoundWhenItsTileIsGlancedAt) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const cv::Mat picture = with_small_hand(test::rendered_hand().picture(), 1 / 2.5, {1100, 500});
  const int turns = turns_that_find(detector, picture);
  EXPECT_GE(turns, 1);
  EXPECT_LT(turns, 6);
}

TEST(RenderedHand, InGreyIsRefinedToTheSamePlace) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const cv::Mat picture = test::rendered_hand().picture();
  const HandPoints points = test::only_hand(detector, picture).landmarks;
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  const auto hand = detector.refine(grey, points);
  ASSERT_TRUE(hand);
  EXPECT_LT(test::mean_distance(hand->landmarks, points), 5);
}

TEST(RenderedHand, AndASecondOneAreBothFound) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const cv::Mat picture = test::rendered_hand().picture();
  const cv::Mat half = picture(cv::Rect(480, 100, 480, 480));
  cv::Mat mirrored, both;
  cv::flip(half, mirrored, 1);
  cv::hconcat(half, mirrored, both);
  const auto hands = detector.detect(both);
  ASSERT_EQ(hands.size(), 2u);
  for (const HandDetection& hand : hands) {
    EXPECT_EQ(hand.right > 0.5, hand.landmarks.row(0).mean() < 480);
  }
  HandDetector of_one({.most_hands = 1});
  EXPECT_EQ(of_one.detect(both).size(), 1u);
}

}  // namespace
}  // namespace hypotrack
