#include "track/color/color_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace hypotrack {
namespace {

/// Pairs around `level` of standard deviation `deviation`, of which the first view shows
/// gain * other + offset, with noise of 2 in both.
ColorSamples pairs(double level, double deviation, double gain, double offset, int count = 800) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  ColorSamples out;
  for (int n = 0; n < count; ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double there = level + deviation * normal(random);
      const double here = gain * there + offset;
      out.first[i].push_back(static_cast<float>(std::clamp(here + 2 * normal(random), 0.0, 255.0)));
      out.other[i].push_back(
          static_cast<float>(std::clamp(there + 2 * normal(random), 0.0, 255.0)));
    }
  }
  return out;
}

void expect_value(const ColorMap& map, double level, double expected, double tolerance) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(map.gain[i] * level + map.offset[i], expected, tolerance) << "channel " << i;
  }
}

TEST(ColorFit, FindsGainAndOffsetWhereColoursVary) {
  const auto map = fit_color_map(pairs(110, 35, 0.9, 6));
  ASSERT_TRUE(map);
  for (const double level : {60, 110, 160}) expect_value(*map, level, 0.9 * level + 6, 1.5);
}

TEST(ColorFit, FindsAPureGainWhereColoursDoNotVary) {
  const auto map = fit_color_map(pairs(110, 1, 0.86, 0));
  ASSERT_TRUE(map);
  for (const double level : {60, 110, 160}) expect_value(*map, level, 0.86 * level, 2.5);
}

TEST(ColorFit, IsNotMisledByAFifthOfTheSamples) {
  ColorSamples samples = pairs(110, 30, 0.9, 6);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<float> any(10, 245);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t n = 0; n < samples.size(); n += 5) samples.first[i][n] = any(random);
  }
  const auto map = fit_color_map(samples);
  ASSERT_TRUE(map);
  for (const double level : {80, 110, 140}) expect_value(*map, level, 0.9 * level + 6, 6);
}

TEST(ColorFit, CorrelationTellsPairsOfTheSamePointFromOthers) {
  ColorSamples samples = pairs(110, 30, 0.9, 6);
  EXPECT_GT(correlation(samples), 0.98);
  std::mt19937_64 random(7);
  for (std::vector<float>& channel : samples.other) std::ranges::shuffle(channel, random);
  EXPECT_NEAR(correlation(samples), 0, 0.1);
}

TEST(ColorFit, CorrelationIsOfTheChannelsThatVary) {
  ColorSamples samples = pairs(110, 30, 0.9, 6);
  std::ranges::fill(samples.first[1], 50.0f);
  EXPECT_GT(correlation(samples), 0.98);
  for (std::vector<float>& channel : samples.first) std::ranges::fill(channel, 50.0f);
  EXPECT_EQ(correlation(samples), 0);
  EXPECT_EQ(correlation({}), 0);
}

TEST(ColorFit, IgnoresWhatACameraHasCutOff) {
  ColorSamples samples = pairs(110, 30, 1.2, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t n = 0; n < samples.size(); n += 2) {
      samples.first[i][n] = 255;
      samples.other[i][n] = 240;
    }
  }
  const auto map = fit_color_map(samples);
  ASSERT_TRUE(map);
  expect_value(*map, 110, 132, 1.5);
}

TEST(ColorFit, SaysNothingWithoutEnoughSamples) {
  EXPECT_FALSE(fit_color_map({}));
  EXPECT_FALSE(fit_color_map(pairs(110, 30, 1, 0, 99)));
  EXPECT_TRUE(fit_color_map(pairs(110, 30, 1, 0, 100)));
}

TEST(ColorFit, SaysNothingWherePairsDoNotAgree) {
  ColorSamples samples = pairs(110, 60, 1, 0);
  std::mt19937_64 random(9);
  for (auto& values : samples.other) std::shuffle(values.begin(), values.end(), random);
  EXPECT_FALSE(fit_color_map(samples));
}

TEST(ColorFit, SaysNothingBeyondWhatCamerasDifferBy) {
  EXPECT_FALSE(fit_color_map(pairs(60, 1, 3, 0)));
  EXPECT_FALSE(fit_color_map(pairs(120, 1, 0.3, 0)));
  EXPECT_FALSE(fit_color_map(pairs(90, 20, 1, 90)));
}

}  // namespace
}  // namespace hypotrack
