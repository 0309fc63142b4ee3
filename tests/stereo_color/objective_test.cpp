#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "hypotrack/error.hpp"
#include "random_pair.hpp"
#include "stereo_color.hpp"

namespace hypotrack::stereo_color {
namespace {

using testing::HasSubstr;

template <class Body>
std::string message_of(Body body) {
  try {
    body();
  } catch (const DataError& e) {
    return e.what();
  }
  return "no DataError";
}

TEST(StereoColor, OneViewIsAnErrorThatSaysWhatIsExpected) {
  RandomPair pair({.size = 32});
  pair.observation.views.pop_back();
  pair.observation.frame = 17;
  StereoColor objective({});
  const std::string message = message_of([&] { objective.prepare(pair.observation); });
  EXPECT_THAT(message, HasSubstr("objective stereo_color"));
  EXPECT_THAT(message, HasSubstr("frame 17 has 1 view;"));
  EXPECT_THAT(message, HasSubstr("expected two calibrated views"));
}

TEST(StereoColor, ImagesOfAnotherSizeOrTypeThanTheTileAreErrors) {
  StereoColor objective({});
  RandomPair small({.size = 32});
  small.observation.views[1].color = cv::Mat3b(31, 32);
  EXPECT_THAT(message_of([&] { objective.prepare(small.observation); }),
              HasSubstr("the colour image of view 1 is 32x31"));
  RandomPair grey({.size = 32});
  grey.observation.views[0].color = cv::Mat1b(32, 32);
  EXPECT_THAT(message_of([&] { objective.prepare(grey.observation); }),
              HasSubstr("the colour image of view 0 is 32x32 of OpenCV type 0"));
  RandomPair mask({.mask = true, .size = 32});
  mask.observation.views[1].mask = cv::Mat1b(8, 8);
  EXPECT_THAT(message_of([&] { objective.prepare(mask.observation); }),
              HasSubstr("the mask of view 1 is 8x8"));
}

TEST(StereoColor, TilesOfAnotherSizeThanThePreparedFrameAreErrors) {
  const RandomPair pair({.size = 32}), other({.size = 48});
  StereoColor objective({});
  objective.prepare(pair.observation);
  EXPECT_THAT(message_of([&] { objective.cost(other.hypothesis()); }),
              HasSubstr("expected a 32x32 tile as view 0"));
  const std::string none = message_of([&] { objective.cost({}); });
  EXPECT_THAT(none, HasSubstr("drawn in 0 views"));
}

TEST(StereoColor, NeedsRendering) { EXPECT_TRUE(StereoColor({}).needs_rendering()); }

TEST(StereoColor, BothDirectionsAreTheMeanOfTheTwo) {
  const RandomPair pair({.size = 64});
  const auto cost = [&](Direction direction) {
    Params params;
    params.direction = direction;
    StereoColor objective(params);
    objective.prepare(pair.observation);
    return objective.cost(pair.hypothesis());
  };
  EXPECT_NE(cost(Direction::left_to_right), cost(Direction::right_to_left));
  EXPECT_DOUBLE_EQ(cost(Direction::both),
                   (cost(Direction::left_to_right) + cost(Direction::right_to_left)) / 2);
}

TEST(StereoColor, DefaultsAreThePapers) {
  const Params params;
  EXPECT_EQ(params.beta, 100);
  EXPECT_DOUBLE_EQ(params.r, 0.003);
  EXPECT_EQ(params.color_space, ColorSpace::rgb);
  EXPECT_EQ(params.aggregation, Aggregation::sum);
  EXPECT_EQ(params.direction, Direction::left_to_right);
  EXPECT_EQ(params.lookup, Lookup::nearest);
}

}  // namespace
}  // namespace hypotrack::stereo_color
