#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "random_pair.hpp"
#include "settings.hpp"
#include "stereo_color.hpp"

namespace hypotrack::stereo_color {
namespace {

using test::message_of;
using testing::HasSubstr;

TEST(StereoColor, OneViewIsAnErrorThatSaysWhatIsExpected) {
  RandomPair pair({.size = 32});
  pair.observation.views.pop_back();
  pair.observation.frame = 17;
  StereoColor objective({});
  const std::string message = message_of<DataError>([&] { objective.prepare(pair.observation); });
  EXPECT_THAT(message, HasSubstr("objective stereo_color"));
  EXPECT_THAT(message, HasSubstr("frame 17 has 1 view;"));
  EXPECT_THAT(message, HasSubstr("expected two calibrated views"));
}

TEST(StereoColor, ImagesOfAnotherSizeOrTypeThanTheTileAreErrors) {
  StereoColor objective({});
  RandomPair small({.size = 32});
  small.observation.views[1].color = cv::Mat3b(31, 32);
  EXPECT_THAT(message_of<DataError>([&] { objective.prepare(small.observation); }),
              HasSubstr("the colour image of view 1 is 32x31"));
  RandomPair grey({.size = 32});
  grey.observation.views[0].color = cv::Mat1b(32, 32);
  EXPECT_THAT(message_of<DataError>([&] { objective.prepare(grey.observation); }),
              HasSubstr("the colour image of view 0 is 32x32 of OpenCV type 0"));
  RandomPair mask({.mask = true, .size = 32});
  mask.observation.views[1].mask = cv::Mat1b(8, 8);
  EXPECT_THAT(message_of<DataError>([&] { objective.prepare(mask.observation); }),
              HasSubstr("the mask of view 1 is 8x8"));
}

TEST(StereoColor, AViewWithoutColourIsAnErrorThatSaysWhatToDo) {
  RandomPair pair({.size = 32});
  pair.observation.views[1].color.release();
  pair.observation.views[1].depth = cv::Mat1f(32, 32, 0.5f);
  StereoColor objective({});
  EXPECT_THAT(message_of<DataError>([&] { objective.prepare(pair.observation); }),
              HasSubstr("objective stereo_color: view 1 has no colour; expected colour images of "
                        "both cameras. Use a stereo source"));
}

TEST(StereoColor, TilesOfAnotherSizeThanThePreparedFrameAreErrors) {
  const RandomPair pair({.size = 32}), other({.size = 48});
  StereoColor objective({});
  objective.prepare(pair.observation);
  EXPECT_THAT(message_of<DataError>([&] { objective.cost(other.hypothesis()); }),
              HasSubstr("expected a 32x32 tile as view 0"));
  const std::string none = message_of<DataError>([&] { objective.cost({}); });
  EXPECT_THAT(none, HasSubstr("drawn in 0 views"));
}

TEST(StereoColor, NeedsRendering) { EXPECT_TRUE(StereoColor({}).needs_rendering()); }

TEST(StereoColor, IsOnTheDeviceWhereItSaysSo) {
  const bool says_so = std::string(capabilities()).starts_with("device ");
  EXPECT_EQ(StereoColor({}).on_device() != nullptr, says_so);
}

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
  EXPECT_EQ(params.falloff, Falloff::exponential);
  EXPECT_EQ(params.coverage_penalty, 0);
  EXPECT_EQ(params.gray_weight, 1);
  EXPECT_EQ(params.beta_by_difference, 0);
  EXPECT_DOUBLE_EQ(params.r, 0.003);
  EXPECT_EQ(params.color_space, ColorSpace::rgb);
  EXPECT_EQ(params.aggregation, Aggregation::sum);
  EXPECT_EQ(params.direction, Direction::left_to_right);
  EXPECT_EQ(params.lookup, Lookup::nearest);
}

Params read(std::string_view yaml) {
  return ParamReader(ConfigNode::parse(yaml, "scene.yaml")).read<Params>();
}

TEST(StereoColor, ParametersAreReadInTheUnitsOfTheirKeys) {
  const Params p = read(
      "{beta: 25, falloff: gaussian, coverage_penalty: 0.1, w_t: 0.2, r_mm: 5, color_space: lab, "
      "distinctiveness: none,\n"
      " aggregation: sum_per_sqrt, direction: both, lookup: bilinear, use_mask: false}");
  EXPECT_EQ(p.beta, 25);
  EXPECT_EQ(p.falloff, Falloff::gaussian);
  EXPECT_EQ(p.coverage_penalty, 0.1);
  EXPECT_EQ(p.w_t, 0.2);
  EXPECT_DOUBLE_EQ(p.r, 0.005);
  EXPECT_EQ(p.color_space, ColorSpace::lab);
  EXPECT_EQ(p.distinctiveness, Distinctiveness::none);
  EXPECT_EQ(p.aggregation, Aggregation::sum_per_sqrt);
  EXPECT_EQ(p.direction, Direction::both);
  EXPECT_EQ(p.lookup, Lookup::bilinear);
  EXPECT_FALSE(p.use_mask);
}

TEST(StereoColor, BetaFollowsTheDifferenceOfTheViewsWithinItsBounds) {
  RandomPair pair({.size = 64});
  const auto cost = [&](double difference, const Params& params) {
    pair.observation.context.color_difference = difference;
    StereoColor objective(params);
    objective.prepare(pair.observation);
    return objective.cost(pair.hypothesis());
  };
  const auto fixed = [&](double beta) {
    Params params;
    params.beta = beta;
    return cost(0.01, params);
  };
  Params params;
  params.beta = 20;
  params.beta_by_difference = 0.8;
  EXPECT_EQ(cost(0, params), fixed(20));  // not known
  EXPECT_EQ(cost(0.1, params), fixed(40));
  EXPECT_EQ(cost(0.001, params), fixed(120));
  // 80, up to half a step of a tenth
  EXPECT_GT(cost(0.01, params), fixed(80 / 1.05));
  EXPECT_LT(cost(0.01, params), fixed(80 * 1.05));
}

TEST(StereoColor, BoundsOfBetaInTheWrongOrderAreRefused) {
  Params params;
  params.beta_min = 50;
  params.beta_max = 30;
  try {
    const StereoColor objective(params);
    FAIL() << "accepted";
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr("beta_min is 50, above beta_max, 30"));
  }
}

TEST(StereoColor, AGrayWeightIsForRgbOnly) {
  Params params;
  params.gray_weight = 0.5;
  EXPECT_NO_THROW(StereoColor{params});
  params.color_space = ColorSpace::lab;
  try {
    const StereoColor objective(params);
    FAIL() << "accepted";
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr("gray_weight is 0.5"));
    EXPECT_THAT(e.what(), HasSubstr("color_space: lab"));
  }
}

TEST(StereoColor, ParametersSurviveTheRunsProtocol) {
  const char* yaml = "{beta: 25, r_mm: 5, color_space: hsv, aggregation: mean_rendered}";
  const std::string once = dump_params(read(yaml));
  EXPECT_THAT(once, HasSubstr("color_space: hsv"));
  EXPECT_EQ(dump_params(read(once)), once);
}

TEST(StereoColor, UnknownWordsAreErrorsThatListTheKnown) {
  try {
    read("{aggregation: sum_per_squirrel}");
    FAIL() << "accepted";
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr("scene.yaml:1"));
    EXPECT_THAT(e.what(), HasSubstr("mean_rendered"));
  }
}

}  // namespace
}  // namespace hypotrack::stereo_color
