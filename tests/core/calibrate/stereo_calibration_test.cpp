#include "calibrate/stereo_calibration.hpp"

#include <gmock/gmock.h>

#include "calibrate/check/check_reach.hpp"
#include "calibrate/check/coverage.hpp"
#include "calibrate/picture_pairs.hpp"
#include "hypotrack/api/error.hpp"
#include "stereo_calibration_fixture.hpp"
#include "test_paths.hpp"

namespace hypotrack::calibrate {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST_F(StereoCalibrationTest, FindsTheCamerasThatTookThePictures) {
  const StereoCalibration found = calibrated(pairs(15, 0.05));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(found.cameras[i].fx, cameras_[i].fx, 1.5);
    EXPECT_NEAR(found.cameras[i].cx, cameras_[i].cx, 1.5);
    EXPECT_NEAR(found.cameras[i].distortion[0], -0.25, 0.02);
  }
  const Eigen::Isometry3d apart =
      found.cameras[1].camera_from_world * cameras_[1].camera_from_world.inverse();
  EXPECT_LT(apart.translation().norm(), 0.0005);
  EXPECT_LT(Eigen::AngleAxisd(apart.linear()).angle(), 0.003);
  EXPECT_NEAR(found.rms, 0.05 * std::sqrt(2), 0.02);
  EXPECT_LT(found.focal_sigma[0], 0.005);
}

TEST_F(StereoCalibrationTest, DropsPairsWhosePicturesDoNotBelongTogether) {
  std::vector<BoardPair> given = pairs(15, 0.1);
  for (cv::Point2f& at : given[4].corners[1].at) at += cv::Point2f(3, 12);
  const StereoCalibration found = calibrated(given);
  for (std::size_t i = 0; i < given.size(); ++i)
    EXPECT_EQ(found.pairs[i].dropped, i == 4) << found.pairs[i].name;
  EXPECT_NEAR(found.cameras[1].camera_from_world.translation().norm(), 0.09, 0.001);
}

TEST_F(StereoCalibrationTest, DropsPairsOfDifferentMomentsOfAFewPairs) {
  std::vector<BoardPair> given = pairs(8, 0.1);
  given[3].corners[1] = given[4].corners[1];
  const StereoCalibration found = calibrated(given);
  for (std::size_t i = 0; i < given.size(); ++i)
    EXPECT_EQ(found.pairs[i].dropped, i == 3) << found.pairs[i].name;
  EXPECT_LT(found.rms, 0.2);
  EXPECT_NEAR(found.cameras[1].camera_from_world.translation().norm(), 0.09, 0.001);
}

TEST_F(StereoCalibrationTest, TakesGivenLensesAsTheyAre) {
  const StereoCalibration found = calibrate_stereo(finder_, {640, 480}, pairs(4, 0.1), cameras_);
  EXPECT_EQ(found.cameras[0].fx, 530);
  EXPECT_EQ(found.cameras[1].distortion, cameras_[1].distortion);
  EXPECT_NEAR(found.cameras[1].camera_from_world.translation().norm(), 0.09, 0.001);
  EXPECT_EQ(found.focal_sigma[0], 0);
}

TEST_F(StereoCalibrationTest, NeedsThreePairs) {
  EXPECT_THAT([&] { calibrated(pairs(2, 0.1)); },
              ThrowsMessage<DataError>(HasSubstr("2 of 2 pairs show the board")));
}

TEST_F(StereoCalibrationTest, RefusesBoardsWithoutExtent) {
  std::vector<BoardPair> given = pairs(4, 0.1);
  for (BoardPair& pair : given)
    for (BoardCorners& corners : pair.corners) std::ranges::fill(corners.at, cv::Point2f(100, 100));
  EXPECT_THAT([&] { calibrated(given); },
              ThrowsMessage<DataError>(HasSubstr("these pairs do not tell the cameras")));
}

TEST_F(StereoCalibrationTest, PairsWithTooFewCommonCornersDoNotCount) {
  std::vector<BoardPair> given = pairs(6, 0.1);
  given[2].corners[0].ids.resize(5);
  given[2].corners[0].at.resize(5);
  const StereoCalibration found = calibrated(given);
  EXPECT_FALSE(found.pairs[2].counts());
  EXPECT_TRUE(found.pairs[3].counts());
}

TEST_F(StereoCalibrationTest, TheVerdictAsksForTiltWhereTheBoardFacedTheCameras) {
  const std::vector<BoardPair> flat = pairs(12, 0.1, 0.02), tilted = pairs(20, 0.1);
  const auto advice = [&](const std::vector<BoardPair>& of) {
    std::string out;
    for (const std::string& one : verdict_of(of, calibrated(of)).advice) out += one;
    return out;
  };
  EXPECT_THAT(advice(flat), HasSubstr("tilt the board more"));
  EXPECT_THAT(advice(tilted), testing::Not(HasSubstr("tilt the board more")));
}

TEST_F(StereoCalibrationTest, SharpCornersThatDoNotFitAreNotCalledGood) {
  const auto verdict = [&](double sharpness) {
    sharpness_ = sharpness;
    const std::vector<BoardPair> given = pairs(12, 0.2);
    return verdict_of(given, calibrated(given));
  };
  EXPECT_THAT(verdict(0).summary, testing::StartsWith("good: 0.2"));
  EXPECT_THAT(verdict(0.08).summary, testing::StartsWith("good: 0.2"));
  const Verdict sharp = verdict(0.03);
  EXPECT_THAT(sharp.summary, testing::StartsWith("usable: 0.2"));
  EXPECT_THAT(sharp.advice[0], HasSubstr("corners as sharp as these are some 0.04 px off"));
}

TEST_F(StereoCalibrationTest, ResidualsOfFewCornersAreWeighedUp) {
  std::vector<BoardPair> few = pairs(12, 0.2);
  const StereoCalibration many = calibrated(few);
  EXPECT_NEAR(many.spread, 0.2 * std::sqrt(2), 0.01);
  for (BoardPair& pair : few)
    for (BoardCorners& corners : pair.corners) {
      BoardCorners kept;
      for (std::size_t i : {0, 4, 8, 20, 26, 45, 49, 53}) {
        kept.ids.push_back(corners.ids[i]);
        kept.at.push_back(corners.at[i]);
      }
      corners = kept;
    }
  const StereoCalibration found = calibrated(few);
  EXPECT_LT(found.rms, many.rms);
  EXPECT_NEAR(found.spread, 0.2 * std::sqrt(2), 0.04);
}

TEST_F(StereoCalibrationTest, ABoardIsMeasuredByTheCameras) {
  sharpness_ = 0.05;
  const BoardPair pair = pairs(1, 0.05)[0];
  const BoardFit right = *fit_board(finder_, cameras_, pair);
  EXPECT_NEAR(right.scale, 1, 0.003);
  EXPECT_NEAR(right.rms, 0.05 * std::sqrt(2), 0.02);
  EXPECT_NEAR(right.expected, 0.05 * std::sqrt(2), 1e-9);
  EXPECT_NEAR(right.depth, 0.45, 0.2);
  std::array<Camera, 2> wide = cameras_;
  wide[1].camera_from_world.translation() *= 1.1;
  EXPECT_NEAR(fit_board(finder_, wide, pair)->scale, 1.1, 0.005);
  std::array<Camera, 2> long_lens = cameras_;
  for (Camera& camera : long_lens) camera.fx = camera.fy *= 1.1;
  EXPECT_GT(fit_board(finder_, long_lens, pair)->rms, 3 * right.rms);
  BoardPair few = pair;
  for (BoardCorners& corners : few.corners) corners.ids.resize(5), corners.at.resize(5);
  EXPECT_FALSE(fit_board(finder_, cameras_, few));
}

TEST_F(StereoCalibrationTest, WhatNoPointTellsIsSaid) {
  MatchedPoints points;
  for (int i = 0; i < 200; ++i) {
    points.depths.push_back(0.4 + 0.001 * i);
    for (auto& pixels : points.pixels)
      pixels.emplace_back(static_cast<float>(i % 20 * 16), static_cast<float>(i / 20 * 48));
  }
  CheckReach reach;
  reach.add(points);
  const std::vector<std::string> spots = reach.blind_spots(cameras_, BoardReach::none);
  ASSERT_EQ(spots.size(), 5u);
  EXPECT_THAT(spots[0], HasSubstr("errors along the epipolar lines"));
  EXPECT_THAT(spots[0], HasSubstr("the baseline of 90.0 mm"));
  EXPECT_EQ(spots[1], "anything nearer than 0.41 m or farther than 0.59 m");
  EXPECT_THAT(spots[2], HasSubstr("the lens in 50 % of the left picture"));
  EXPECT_THAT(spots[3], HasSubstr("right and the bottom right"));
  EXPECT_THAT(spots[4], HasSubstr("centres that are some pixels off"));
  points.flat = true;
  CheckReach flat;
  flat.add(points);
  EXPECT_THAT(flat.blind_spots(cameras_, BoardReach::measured),
              testing::Contains(HasSubstr("lie on one plane")));
  EXPECT_THAT(flat.blind_spots(cameras_, BoardReach::measured),
              testing::Not(testing::Contains(HasSubstr("epipolar"))));
  const std::vector<std::string> calibrated = flat.blind_spots(cameras_, BoardReach::calibrated);
  EXPECT_THAT(calibrated, testing::Not(testing::Contains(HasSubstr("lie on one plane"))));
  EXPECT_THAT(calibrated, testing::Not(testing::Contains(HasSubstr("centres"))));
}

TEST_F(StereoCalibrationTest, TheVerdictSaysWhichPartsOfPicturesSawNoBoard) {
  std::vector<BoardPair> given = pairs(12, 0.1);
  const StereoCalibration found = calibrated(given);
  for (BoardPair& pair : given)
    for (cv::Point2f& at : pair.corners[0].at) at.x /= 2;
  const Coverage left = coverage_of(given, found, 0);
  EXPECT_LT(left.share, 0.6);
  EXPECT_THAT(left.empty, testing::Contains("right"));
  EXPECT_EQ(draw_coverage(given, found).size(), cv::Size(1280, 480));
}

TEST(RealChessboards, AreCalibratedAsWellAsByOpenCv) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const BoardFinder finder(parse_board("9x6", "25mm"));
  const std::string folder = (test::shared_data() / "calib/chessboard").string();
  std::vector<BoardPair> pairs;
  read_pairs({folder + "/left*.jpg", folder + "/right*.jpg"}, [&](const PicturePair& pair) {
    BoardPair board{pair.name, {finder.find(pair.left), finder.find(pair.right)}};
    number_alike(board.corners[0], board.corners[1]);
    pairs.push_back(std::move(board));
  });
  ASSERT_EQ(pairs.size(), 13u);
  const StereoCalibration found = calibrate_stereo(finder, {640, 480}, pairs);
  EXPECT_LT(found.rms, 0.22);
  for (const PairResidual& pair : found.pairs) EXPECT_TRUE(pair.counts()) << pair.name;
  EXPECT_NEAR(found.cameras[1].camera_from_world.translation().norm(), 0.0832, 0.0002);
}

}  // namespace
}  // namespace hypotrack::calibrate
