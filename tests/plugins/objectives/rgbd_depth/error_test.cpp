#include "hypotrack/api/error.hpp"

#include <gtest/gtest.h>

#include <string>

#include "depth_scene.hpp"
#include "expect_error.hpp"
#include "rgbd_depth.hpp"

namespace hypotrack::rgbd_depth {
namespace {

using test::message_of;
using testing::HasSubstr;

std::string refusal(const Observation& observation, Foreground foreground) {
  Params params;
  params.foreground = foreground;
  RgbdDepth objective(params);
  return message_of<DataError>([&] { objective.prepare(observation); });
}

TEST(RgbdDepth, NoDepthIsAnErrorThatSaysWhatIsExpected) {
  Observation observation = blank_observation(4);
  observation.frame = 17;
  observation.views[0].depth.release();
  const std::string one = refusal(observation, Foreground::automatic);
  EXPECT_THAT(one, HasSubstr("objective rgbd_depth: frame 17 has 1 view, none with depth"));
  EXPECT_THAT(one, HasSubstr("Use a source of depth images"));
  observation.views.push_back(observation.views[0]);
  EXPECT_THAT(refusal(observation, Foreground::automatic), HasSubstr("has 2 views, none"));
  observation.views.clear();
  EXPECT_THAT(refusal(observation, Foreground::automatic), HasSubstr("has 0 views, none"));
}

TEST(RgbdDepth, AForegroundThatTheViewLacksIsAnErrorThatNamesTheWayOut) {
  Observation observation = blank_observation(4);
  observation.frame = 3;
  const std::string mask = refusal(observation, Foreground::mask);
  EXPECT_THAT(mask, HasSubstr("view 0 of frame 3 has depth but no mask"));
  EXPECT_THAT(mask, HasSubstr("`foreground: depth`"));
  EXPECT_THAT(refusal(observation, Foreground::skin), HasSubstr("has depth but no colour"));
}

TEST(RgbdDepth, ImagesOfAnotherSizeOrTypeThanTheTileAreErrors) {
  Observation millimetres = blank_observation(4);
  millimetres.views[0].depth = cv::Mat1w(4, 4);
  EXPECT_THAT(refusal(millimetres, Foreground::depth),
              HasSubstr("the depth image of view 0 is 4x4 of OpenCV type 2"));
  Observation small = blank_observation(4);
  small.views[0].valid = cv::Mat1b(3, 4);
  EXPECT_THAT(refusal(small, Foreground::depth), HasSubstr("the valid image of view 0 is 4x3"));
  Observation mask = blank_observation(4);
  mask.views[0].mask = cv::Mat1b(8, 8);
  EXPECT_THAT(refusal(mask, Foreground::automatic), HasSubstr("the mask of view 0 is 8x8"));
  Observation grey = blank_observation(4);
  grey.views[0].color = cv::Mat1b(4, 4);
  EXPECT_THAT(refusal(grey, Foreground::skin), HasSubstr("the colour image of view 0 is 4x4"));
}

TEST(RgbdDepth, TilesOfAnotherSizeThanThePreparedFrameAreErrors) {
  RgbdDepth objective({});
  objective.prepare(blank_observation(4));
  const Drawn other({Grid(25)}, 5);
  EXPECT_THAT(message_of<DataError>([&] { objective.cost(other.hypothesis()); }),
              HasSubstr("expected a 4x4 tile as view 0"));
  EXPECT_THAT(message_of<DataError>([&] { objective.cost({}); }), HasSubstr("drawn in 0 views"));
}

TEST(RgbdDepth, ARefusedFrameLeavesNothingBehind) {
  RgbdDepth objective({});
  objective.prepare(blank_observation(4));
  Observation none = blank_observation(4);
  none.views.clear();
  message_of<DataError>([&] { objective.prepare(none); });
  objective.prepare(blank_observation(5));
  EXPECT_EQ(objective.cost(Drawn({Grid(25)}, 5).hypothesis()), 20);
}

Params read(std::string_view yaml) {
  return ParamReader(ConfigNode::parse(yaml, "scene.yaml")).read<Params>();
}

TEST(RgbdDepth, ParametersAreReadInTheUnitsOfTheirKeys) {
  const Params p = read(
      "{d_max_mm: 50, d_match_mm: 5, lambda: 3, lambda_k: 4, foreground: skin, range_mm: 250}");
  EXPECT_DOUBLE_EQ(p.d_max, 0.05);
  EXPECT_DOUBLE_EQ(p.d_match, 0.005);
  EXPECT_EQ(p.lambda, 3);
  EXPECT_EQ(p.lambda_k, 4);
  EXPECT_EQ(p.foreground, Foreground::skin);
  EXPECT_DOUBLE_EQ(p.range, 0.25);
}

TEST(RgbdDepth, ParametersSurviveTheRunsProtocol) {
  const std::string once = dump_params(read("{foreground: auto, d_max_mm: 30}"));
  EXPECT_THAT(once, HasSubstr("foreground: auto"));
  EXPECT_EQ(dump_params(read(once)), once);
}

TEST(RgbdDepth, UnknownWordsAreErrorsThatListTheKnown) {
  const std::string message = message_of<ConfigError>([] { read("{foreground: colour}"); });
  EXPECT_THAT(message, HasSubstr("scene.yaml:1"));
  EXPECT_THAT(message, HasSubstr("skin"));
}

}  // namespace
}  // namespace hypotrack::rgbd_depth
