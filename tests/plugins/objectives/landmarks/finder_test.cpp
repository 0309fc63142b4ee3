// How often the detector looks at a frame.
#include <gtest/gtest.h>

#include "hands_in_view.hpp"

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

}  // namespace
}  // namespace hypotrack::landmarks
