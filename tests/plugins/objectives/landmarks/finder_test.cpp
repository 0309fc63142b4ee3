// How often the detector looks at a frame.
#include <gtest/gtest.h>

#include "hands_in_view.hpp"
#include "plugin/plugin_notes.hpp"

namespace hypotrack::landmarks {
namespace {

using test::hypothesis;
using test::relaxed;

class HandFinderTest : public ::testing::Test {
 protected:
  double cost_of(const Observation& observation) {
    sees_.seen = observation;
    objective_.prepare(sees_.seen);
    return objective_.cost(hypothesis(test::bent(relaxed(), "hand.index", 1)));
  }

  test::SeesState sees_{relaxed()};
  Landmarks objective_{{}, test::two_hands(), sees_.detector()};
};

TEST_F(HandFinderTest, LooksOnceAtEachViewOfAFrame) {
  const double cost = cost_of(test::observation(relaxed()));
  EXPECT_EQ(sees_.refined, 4) << "two hands in two views";
  EXPECT_EQ(sees_.detected, 0);
  EXPECT_EQ(cost_of(test::observation(relaxed())), cost);
  EXPECT_EQ(cost_of(test::observation(test::bent(relaxed(), "hand.ring", 0.5))), cost);
  EXPECT_EQ(sees_.refined, 4);
  EXPECT_EQ(cost_of(test::observation(relaxed(), 1)), cost);
  EXPECT_EQ(sees_.refined, 8);
  EXPECT_EQ(cost_of(test::observation(relaxed(), 0)), cost) << "goes back as smoothing does";
  EXPECT_EQ(sees_.refined, 8);
}

TEST_F(HandFinderTest, LooksOnceAtFramesOfSmoothingThatGoesBackBy20Seconds) {
  constexpr int kFrames = 600;
  for (int round = 0; round < 2; ++round)
    for (int frame = 0; frame < kFrames; ++frame) cost_of(test::observation(relaxed(), frame));
  EXPECT_EQ(sees_.refined, 4 * kFrames);
}

TEST_F(HandFinderTest, LooksForHandsInTheWholeTileIfNoneIsWhereTheSearchStarts) {
  Eigen::VectorXd start = relaxed();
  start[0] += 0.15;
  EXPECT_GT(cost_of(test::observation(start)), 0.1);
  EXPECT_EQ(sees_.detected, 2);
}

TEST_F(HandFinderTest, LooksAgainWhereATileShowsAnotherPartOfThePicture) {
  sees_.left = false;
  cost_of(test::observation(relaxed()));
  EXPECT_EQ(sees_.detected, 2);
  cost_of(test::observation(relaxed()));
  EXPECT_EQ(sees_.detected, 2) << "it was not there before";
  sees_.left = true;
  Observation elsewhere = test::observation(relaxed());
  for (TileView& view : elsewhere.views) view.camera.cx += 40;
  cost_of(elsewhere);
  EXPECT_EQ(sees_.refined, 6);
}

/// Returns an observation of frame 1, of which frame 0 was tracked in a state.
Observation next_observation(const Eigen::VectorXd& start, const Eigen::VectorXd& before) {
  Observation out = test::observation(start, 1);
  auto previous = std::make_shared<PreviousSolution>();
  previous->state = before;
  out.context.previous = previous;
  return out;
}

TEST_F(HandFinderTest, FollowsTheHandsOfTheLastFrame) {
  const double cost = cost_of(test::observation(relaxed()));
  EXPECT_EQ(sees_.followed, 0);
  EXPECT_EQ(cost_of(next_observation(relaxed(), relaxed())), cost);
  EXPECT_EQ(sees_.followed, 4);
  EXPECT_EQ(sees_.refined, 8);
}

TEST_F(HandFinderTest, FollowsAHandToWhereTheModelIsExpected) {
  // The model lies 6 cm beside what is seen, in both frames, and moves by as much in between: what
  // was seen moves with it, away from where the model itself is.
  Eigen::VectorXd before = relaxed();
  before[0] -= 0.06;
  cost_of(test::observation(before));
  ASSERT_EQ(sees_.refined, 4);
  cost_of(next_observation(before, before));
  EXPECT_EQ(sees_.followed, 4);
  EXPECT_LT(sees_.farthest_followed, 1) << "pixels";
}

TEST_F(HandFinderTest, LooksNearTheModelIfTheLastFrameIsUnknown) {
  cost_of(next_observation(relaxed(), relaxed()));
  EXPECT_EQ(sees_.followed, 0);
  EXPECT_EQ(sees_.refined, 4);
}

TEST(MovedHand, TurnsGrowsAndShiftsAsTheModel) {
  HandPoints hand = HandPoints::Random(), from = HandPoints::Random();
  const Eigen::Matrix2d turn = 1.3 * Eigen::Rotation2Dd(0.7).toRotationMatrix();
  const auto move = [&](const HandPoints& p) -> HandPoints {
    return (turn * p).colwise() + Eigen::Vector2d(4, -9);
  };
  from.col(3).setConstant(NAN);  // a point that the model does not have
  EXPECT_TRUE(moved(hand, from, move(from)).isApprox(move(hand), 1e-9));
}

TEST(MovedHand, IsNotFiniteWhereTheModelHasOnePoint) {
  HandPoints one = HandPoints::Constant(NAN);
  one.col(0) << 1, 2;
  EXPECT_FALSE(moved(HandPoints::Random(), one, one).allFinite());
}

TEST_F(HandFinderTest, WarnsOnceOfHandsThatAreOfTheOtherSideInManyFrames) {
  const auto notes = std::make_shared<PluginNotes>();
  Landmarks objective({}, test::two_hands(), sees_.detector(), {notes, "objective (landmarks)"});
  const auto track = [&](int first, int end) {
    for (int frame = first; frame < end; ++frame) {
      sees_.seen = test::observation(relaxed(), frame);
      objective.prepare(sees_.seen);
      objective.prepare(sees_.seen);
    }
    return notes->take_lines();
  };
  EXPECT_TRUE(track(0, 10).empty());
  sees_.exchanged = true;
  EXPECT_TRUE(track(10, 17).empty());
  sees_.exchanged = false;
  EXPECT_TRUE(track(17, 18).empty());
  sees_.exchanged = true;
  EXPECT_TRUE(track(18, 25).empty());
  const std::vector<std::string> lines = track(25, 60);
  ASSERT_EQ(lines.size(), 2) << "one per model";
  EXPECT_NE(lines[0].find("the detector sees a left hand where 'hand' is, a right one"),
            std::string::npos)
      << lines[0];
}

}  // namespace
}  // namespace hypotrack::landmarks
