#include <gmock/gmock.h>

#include <numbers>

#include "calibrate/stereo_calibration.hpp"
#include "hypotrack/api/error.hpp"
#include "stereo_calibration_fixture.hpp"

namespace hypotrack::calibrate {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using testing::ThrowsMessage;

class FaultsTest : public StereoCalibrationTest {
 protected:
  FaultsTest() { sharpness_ = 0.04; }

  Verdict verdict(const std::vector<BoardPair>& of) {
    return verdict_of(of, calibrate_stereo(finder_, {640, 480}, of));
  }
  void expect_error(const std::vector<BoardPair>& of, const char* text) {
    EXPECT_THAT([&] { calibrated(of); }, ThrowsMessage<DataError>(HasSubstr(text)));
  }
  /// Flips the right pictures of boards, of which corners are found from the top left on.
  std::vector<BoardPair> flipped(bool sideways, bool upright) {
    std::vector<BoardPair> out = pairs(8, 0.05, 0.3);
    for (BoardPair& pair : out) {
      const std::vector<cv::Point2f> at = pair.corners[1].at;
      for (int i = 0; i < 54; ++i) {
        const int row = upright ? 5 - i / 9 : i / 9, column = sideways ? 8 - i % 9 : i % 9;
        cv::Point2f to = at[static_cast<std::size_t>(9 * row + column)];
        if (sideways) to.x = 639 - to.x;
        if (upright) to.y = 479 - to.y;
        pair.corners[1].at[static_cast<std::size_t>(i)] = to;
      }
    }
    return out;
  }
};

TEST_F(FaultsTest, SquaresThatAreNotSquareAreMeasured) {
  EXPECT_THAT(verdict(pairs(8, 0.04)).summary, StartsWith("good: "));
  stretch_ = 1.01;
  const Verdict longer = verdict(pairs(8, 0.04));
  EXPECT_THAT(longer.summary, StartsWith("usable: "));
  EXPECT_THAT(longer.advice[0], HasSubstr("look 1.0 % longer along the board's rows"));
  stretch_ = 0.96;
  const Verdict shorter = verdict(pairs(8, 0.04));
  EXPECT_THAT(shorter.summary, Not(StartsWith("good")));
  EXPECT_THAT(shorter.advice[0], HasSubstr("% shorter along the board's rows"));
}

TEST_F(FaultsTest, PixelsThatAreNotSquareAreNoFault) {
  for (Camera& camera : cameras_) camera.fx = 1.06 * camera.fy;
  std::vector<BoardPair> given = pairs(8, 0.04);
  EXPECT_THAT(calibrated(given).faults, IsEmpty());
  EXPECT_THAT(verdict(given).summary, StartsWith("good: "));
}

TEST_F(FaultsTest, CamerasOnExchangedSidesAreNamed) {
  std::vector<BoardPair> given = pairs(8, 0.05);
  for (BoardPair& pair : given) std::swap(pair.corners[0], pair.corners[1]);
  const Verdict found = verdict(given);
  EXPECT_THAT(found.summary, StartsWith("usable: "));
  EXPECT_THAT(found.advice[0], AllOf(HasSubstr("to the left of the left one"),
                                     HasSubstr("are --left and --right exchanged")));
}

TEST_F(FaultsTest, OneCameraInPlaceOfTwoIsNamed) {
  std::vector<BoardPair> given = pairs(8, 0.05);
  for (BoardPair& pair : given) pair.corners[1] = pair.corners[0];
  const Verdict found = verdict(given);
  EXPECT_THAT(found.summary, StartsWith("usable: "));
  EXPECT_THAT(found.advice[0], HasSubstr("are the left and the right pictures the same?"));
}

TEST_F(FaultsTest, FlippedPicturesOfOneCameraAreNamed) {
  expect_error(flipped(true, false), "pictures of one camera are mirrored, left and right");
  expect_error(flipped(false, true), "pictures of one camera are mirrored, top and bottom");
  expect_error(flipped(true, true), "pictures of one camera are upside down");
}

TEST_F(FaultsTest, ACameraMayBeMountedUpsideDownIfCornersHaveNumbers) {
  cameras_[1].camera_from_world.linear() =
      Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()) *
      cameras_[1].camera_from_world.linear();
  cameras_[1].camera_from_world.translation() << 0.09, -0.002, 0.001;
  const StereoCalibration found = calibrated(pairs(8, 0.05));
  const Eigen::Isometry3d apart =
      found.cameras[1].camera_from_world * cameras_[1].camera_from_world.inverse();
  EXPECT_LT(apart.translation().norm(), 0.001);
  EXPECT_LT(found.rms, 0.1);
}

TEST_F(FaultsTest, PicturesInAnotherOrderAreNamed) {
  const std::vector<BoardPair> right = pairs(8, 0.05);
  std::vector<BoardPair> late = right;
  for (std::size_t i = 0; i < 8; ++i) late[i].corners[1] = right[(i + 7) % 8].corners[1];
  expect_error(late,
               "the left picture of the pair pair 0 fits the right picture of the pair pair 1");
  std::vector<BoardPair> reversed = right;
  for (std::size_t i = 0; i < 8; ++i) reversed[i].corners[1] = right[7 - i].corners[1];
  expect_error(reversed, "pair 0 fits the right picture of the pair pair 7");
}

TEST_F(FaultsTest, PairsOfDifferentMomentsContradictEachOther) {
  std::vector<BoardPair> given = pairs(8, 0.05), others = pairs(8, 0.05);
  for (std::size_t i = 0; i < 8; ++i) given[i].corners[1] = others[i].corners[1];
  expect_error(given, "the pairs contradict each other");
}

TEST_F(FaultsTest, ExchangedPicturesOfOnePairAreDroppedAndNamed) {
  std::vector<BoardPair> given = pairs(8, 0.05);
  std::swap(given[2].corners[0], given[2].corners[1]);
  const StereoCalibration found = calibrated(given);
  for (std::size_t i = 0; i < given.size(); ++i) {
    EXPECT_EQ(found.pairs[i].dropped, i == 2);
    EXPECT_EQ(found.pairs[i].exchanged, i == 2);
  }
  EXPECT_NEAR(found.cameras[1].camera_from_world.translation().norm(), 0.09, 0.001);
}

TEST_F(FaultsTest, ParallelBoardsTellNoFocalLengths) {
  const std::vector<BoardPair> flat = pairs(8, 0.04, 0.01);
  const Verdict found = verdict(flat);
  EXPECT_FALSE(found.usable);
  EXPECT_THAT(found.summary, AllOf(StartsWith("not usable: "), HasSubstr("are parallel")));
  const StereoCalibration posed = calibrate_stereo(finder_, {640, 480}, flat, cameras_);
  EXPECT_TRUE(verdict_of(flat, posed).usable);
}

TEST_F(FaultsTest, ManyDroppedPairsAreAskedAbout) {
  std::vector<BoardPair> given = pairs(9, 0.05), others = pairs(3, 0.05);
  for (std::size_t i = 0; i < 3; ++i) given[i].corners[1] = others[i].corners[1];
  EXPECT_THAT(verdict(given).advice,
              testing::Contains(HasSubstr("3 of 9 pairs are dropped: are both pictures")));
}

TEST_F(FaultsTest, BoardsAtTheSamePlaceAreRecognised) {
  const std::vector<BoardPair> given = pairs(2, 0.05);
  BoardPair again = given[0];
  for (cv::Point2f& at : again.corners[1].at) at.x += 0.1F;
  EXPECT_TRUE(same_place(given[0], again));
  EXPECT_FALSE(same_place(given[0], given[1]));
  again.corners[0].ids.pop_back();
  again.corners[0].at.pop_back();
  EXPECT_FALSE(same_place(given[0], again));
}

}  // namespace
}  // namespace hypotrack::calibrate
