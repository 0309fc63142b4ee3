#include "calibrate/pair_collector.hpp"

#include <gmock/gmock.h>

#include <opencv2/imgproc.hpp>

#include "calibrate/board/charuco.hpp"
#include "rendered_board.hpp"

namespace hypotrack::calibrate {
namespace {

using test::RenderedBoard;
using testing::Contains;
using testing::IsEmpty;
using Board_ = PairLook::Board;

/// A rendered board before a collector, which looks 20 times a second.
class PairCollectorTest : public testing::Test {
 protected:
  PairLook look(const Eigen::Isometry3d& pose) {
    return look(board_.picture(0, pose), board_.picture(1, pose));
  }
  PairLook look(const cv::Mat& left, const cv::Mat& right) {
    time_ += 0.05;
    return collector_.look(time_, left, right);
  }
  /// Looks at a board that is held still for some time. Returns what was seen each time.
  std::vector<Board_> hold(const Eigen::Isometry3d& pose, int looks = 10) {
    const cv::Mat left = board_.picture(0, pose), right = board_.picture(1, pose);
    std::vector<Board_> out;
    for (int i = 0; i < looks; ++i) out.push_back(look(left, right).board);
    return out;
  }

  RenderedBoard board_;
  BoardFinder finder_{parse_board("9x6", "25mm")};
  PairCollector collector_{finder_, {320, 240}};
  Eigen::Isometry3d pose_ = RenderedBoard::poses()[0];
  double time_ = 0;
};

TEST_F(PairCollectorTest, ABoardThatHoldsStillIsTakenOnce) {
  const std::vector<Board_> seen = hold(pose_, 12);
  EXPECT_EQ(std::ranges::count(seen, Board_::taken), 1);
  EXPECT_EQ(seen.front(), Board_::moving);
  EXPECT_EQ(seen.back(), Board_::known);
  ASSERT_EQ(collector_.pairs().size(), 1u);
  EXPECT_EQ(collector_.pairs()[0].corners[1].at.size(), 54u);
}

TEST_F(PairCollectorTest, ABoardThatMovesIsNotTaken) {
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(look(RenderedBoard::pose({0.002 * i, 0, 0.4}, 0, 0)).board, Board_::moving);
}

TEST_F(PairCollectorTest, ABoardThatDriftsSlowlyIsNotTaken) {
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(look(RenderedBoard::pose({0.0003 * i, 0, 0.4}, 0, 0)).board, Board_::moving);
}

TEST_F(PairCollectorTest, OnlyNewPosesAreTaken) {
  hold(pose_);
  EXPECT_THAT(hold(Eigen::Translation3d(0.005, 0, 0) * pose_),
              testing::Not(Contains(Board_::taken)));
  EXPECT_THAT(hold(Eigen::Translation3d(0, 0, 0.1) * pose_), Contains(Board_::taken));
  EXPECT_THAT(hold(RenderedBoard::pose({0.03, 0, 0.36}, 20, 0)), Contains(Board_::taken));
}

TEST_F(PairCollectorTest, ABoardInOnePictureOnlyIsSaidAndNotTaken) {
  const cv::Mat empty(240, 320, CV_8UC3, cv::Scalar::all(120));
  const PairLook seen = look(board_.picture(0, pose_), empty);
  EXPECT_EQ(seen.board, Board_::missing);
  EXPECT_EQ(seen.problems[0], "");
  EXPECT_NE(seen.problems[1], "");
}

TEST_F(PairCollectorTest, WhyABoardIsNotSeenIsSaid) {
  const auto problem = [&](const cv::Mat& left) {
    return look(left, board_.picture(1, pose_)).problems[0];
  };
  const cv::Mat good = board_.picture(0, pose_);
  cv::Mat blurred;
  cv::GaussianBlur(good, blurred, {}, 9);
  cv::Mat scene(240, 320, CV_8UC3, cv::Scalar::all(60));
  cv::rectangle(scene, {40, 50, 90, 120}, cv::Scalar::all(200), cv::FILLED);
  EXPECT_EQ(problem(good), "");
  EXPECT_EQ(problem(0.1 * scene), "too dark");
  EXPECT_EQ(problem(scene + cv::Scalar::all(240)), "too bright");
  EXPECT_EQ(problem(cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(120))),
            "nothing is seen: is the lens covered?");
  EXPECT_EQ(problem(blurred), "blurred");
  time_ += 5;
  EXPECT_EQ(problem(scene), "no board is seen");
}

TEST_F(PairCollectorTest, ABoardThatLeavesThePictureIsCutAtThatEdge) {
  EXPECT_EQ(look(RenderedBoard::pose({-0.09, 0, 0.4}, 0, 0)).problems[0], "");
  EXPECT_EQ(look(RenderedBoard::pose({-0.12, 0, 0.4}, 0, 0)).problems[0],
            "the board is cut at the left edge");
}

TEST_F(PairCollectorTest, PicturesOfDifferentPartsOfABoardAreNoPair) {
  const Board board = parse_board("charuco:7x5", "30mm");
  const BoardFinder finder(board);
  const cv::Mat whole = CharucoFinder(board).drawn(94, 21);
  PairCollector collector(finder, whole.size());
  cv::Mat first = whole.clone(), second = whole.clone();
  first.colRange(360, whole.cols) = 255;
  second.colRange(0, 320) = 255;
  EXPECT_EQ(collector.look(0, whole, first).board, Board_::moving);
  EXPECT_EQ(collector.look(1, first, second).problems[0],
            "the other picture shows another part of the board");
}

TEST_F(PairCollectorTest, ABoardOfAnotherSizeIsSaid) {
  const BoardFinder finder(parse_board("10x7", "25mm"));
  PairCollector collector(finder, {320, 240});
  const PairLook seen = collector.look(0, board_.picture(0, pose_), board_.picture(1, pose_));
  EXPECT_THAT(seen.problems[0], testing::HasSubstr("a chessboard of 9x6 inner corners"));
}

TEST_F(PairCollectorTest, WhatPairsLackIsWantedUntilTheyHaveIt) {
  EXPECT_THAT(collector_.coverage().wanted,
              Contains("board into the top left of the left picture"));
  hold(RenderedBoard::poses()[0]);
  EXPECT_THAT(collector_.coverage().wanted, Contains("tilt the board by 30 degrees, its top away"));
  for (const Eigen::Isometry3d& pose : RenderedBoard::poses())
    EXPECT_THAT(hold(pose), testing::AnyOf(Contains(Board_::taken), Contains(Board_::known)))
        << pose.translation().transpose();
  EXPECT_THAT(collector_.coverage().wanted, IsEmpty());
  EXPECT_EQ(collector_.coverage().tilts, 4);
}

TEST_F(PairCollectorTest, TiltsAreToldByTheSideThatIsFartherAway) {
  const auto lacks = [&](const Eigen::Isometry3d& pose) {
    PairCollector one(finder_, {320, 240});
    const cv::Mat left = board_.picture(0, pose), right = board_.picture(1, pose);
    for (int i = 0; i < 10; ++i) one.look(time_ += 0.05, left, right);
    std::string sides;
    for (const std::string& wanted : one.coverage().wanted)
      for (const char* side : {"top", "bottom", "left", "right"})
        if (wanted.find(std::string("its ") + side) != std::string::npos)
          sides += side + std::string(" ");
    return sides;
  };
  const Eigen::Vector3d middle(0.03, 0, 0.38);
  EXPECT_EQ(lacks(RenderedBoard::pose(middle, -30, 0)), "bottom left right ");
  EXPECT_EQ(lacks(RenderedBoard::pose(middle, 30, 0)), "top left right ");
  EXPECT_EQ(lacks(RenderedBoard::pose(middle, 0, 30)), "top bottom right ");
  EXPECT_EQ(lacks(RenderedBoard::pose(middle, 0, -30)), "top bottom left ");
}

TEST_F(PairCollectorTest, TakenPairsCalibrateTheCamerasThatSawThem) {
  for (const Eigen::Isometry3d& pose : RenderedBoard::poses()) hold(pose);
  const StereoCalibration found = calibrate_stereo(finder_, {320, 240}, collector_.pairs());
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(found.cameras[i].fx, board_.cameras[i].fx, 2);
    EXPECT_NEAR(found.cameras[i].cx, board_.cameras[i].cx, 2);
  }
  EXPECT_NEAR(found.cameras[1].camera_from_world.translation().x(), -0.06, 0.0006);
}

}  // namespace
}  // namespace hypotrack::calibrate
