#include "features.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "random_pair.hpp"
#include "reference.hpp"

namespace hypotrack::stereo_color {
namespace {

constexpr double kHalfStep = 0.51 / 65535;  // of the 16-bit packing

TileView one_color(const cv::Vec3b& bgr) {
  TileView view;
  view.camera = {4, 4, 100, 100, 2, 2, Eigen::Isometry3d::Identity()};
  view.color = cv::Mat3b(4, 4, bgr);
  view.valid = cv::Mat1b(4, 4, uchar{255});
  return view;
}

// Channel 0, 1, 2 and weight of a pixel.
cv::Vec4d unpack(const Features& f, int x, int y) {
  const std::uint32_t a = f.channels_01.row(y)[x], b = f.channel_2_weight.row(y)[x];
  return cv::Vec4d(a & 0xFFFFu, a >> 16, b & 0xFFFFu, b >> 16) / 65535.0;
}

void expect_channels(const cv::Vec3b& bgr, ColorSpace space, const cv::Vec3d& expected,
                     double tolerance) {
  Params params;
  params.color_space = space;
  const cv::Vec4d found = unpack(make_features(one_color(bgr), params), 1, 2);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << "channel " << i;
}

TEST(Features, RgbIsEightBitValuesOver255) {
  expect_channels({10, 20, 30}, ColorSpace::rgb, {30 / 255.0, 20 / 255.0, 10 / 255.0}, 1e-9);
}

double distance(const cv::Vec3b& a, const cv::Vec3b& b, double gray_weight) {
  Params params;
  params.gray_weight = gray_weight;
  const cv::Vec4d p = unpack(make_features(one_color(a), params), 0, 0);
  const cv::Vec4d q = unpack(make_features(one_color(b), params), 0, 0);
  return cv::norm(p - q);
}

TEST(Features, AGrayWeightLessensWhatChannelsShareAndNothingElse) {
  const cv::Vec3b skin(110, 140, 200);
  for (const double weight : {0.0, 0.25, 0.5, 1.0}) {
    SCOPED_TRACE(weight);
    const double packing = 4 * kHalfStep;
    EXPECT_NEAR(distance(skin, {125, 155, 215}, weight), weight * std::sqrt(3.0) * 15 / 255,
                packing);
    EXPECT_NEAR(distance(skin, {110 - 20, 140, 200 + 20}, weight), std::sqrt(2.0) * 20 / 255,
                packing);
    // 20 in red: 20 / 3 in every channel, and the rest.
    EXPECT_NEAR(distance(skin, {110, 140, 220}, weight),
                20.0 / 255 * std::sqrt(weight * weight / 3 + 2.0 / 3), packing);
  }
}

TEST(Features, GrayIsLuma) {
  expect_channels({10, 20, 30}, ColorSpace::gray,
                  {(0.299 * 30 + 0.587 * 20 + 0.114 * 10) / 255, 0, 0}, kHalfStep);
}

TEST(Features, LabIsScaledToUnitRange) {
  // CIE Lab of sRGB red (D65): 53.24, 80.09, 67.20.
  expect_channels({0, 0, 255}, ColorSpace::lab, {0.5324, (80.09 + 128) / 255, (67.20 + 128) / 255},
                  2e-3);
  expect_channels({255, 255, 255}, ColorSpace::lab, {1, 128 / 255.0, 128 / 255.0}, 1e-3);
}

TEST(Features, HsvIsOnACone) {
  expect_channels({0, 0, 255}, ColorSpace::hsv, {1, 0.5, 1}, 1e-4);
  expect_channels({0, 255, 0}, ColorSpace::hsv, {0.25, 0.5 + std::sqrt(3.0) / 4, 1}, 1e-4);
  expect_channels({0, 0, 0}, ColorSpace::hsv, {0.5, 0.5, 0}, 1e-4);
  // Red with a touch of blue and red with a touch of green have hues near 360 and 0 degrees.
  Params params;
  params.color_space = ColorSpace::hsv;
  const cv::Vec4d a = unpack(make_features(one_color({4, 0, 255}), params), 0, 0);
  const cv::Vec4d b = unpack(make_features(one_color({0, 4, 255}), params), 0, 0);
  EXPECT_LT(cv::norm(a - b), 0.02);
}

TEST(Features, WeightsAreTheReferences) {
  for (const bool mask : {false, true}) {
    const RandomPair pair({.mask = mask, .size = 64});
    for (const TileView& view : pair.observation.views) {
      const Features f = make_features(view, Params{});
      const auto expected = reference::weights(view, Params{});
      for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
          EXPECT_NEAR(unpack(f, x, y)[3], expected[static_cast<std::size_t>(y * 64 + x)], 2e-5);
        }
      }
    }
  }
}

TEST(Features, InvalidPixelsWeighNothing) {
  TileView view = one_color({1, 2, 3});
  view.valid.at<uchar>(2, 3) = 0;
  for (const auto d : {Distinctiveness::none, Distinctiveness::principal_curvatures}) {
    Params params;
    params.distinctiveness = d;
    const Features f = make_features(view, params);
    EXPECT_EQ(unpack(f, 3, 2)[3], 0);
    EXPECT_GT(unpack(f, 2, 3)[3], 0);
  }
}

TEST(Features, BackgroundWeighsNothingUnlessTheMaskIsOff) {
  TileView view = one_color({1, 2, 3});
  view.mask = cv::Mat1b(4, 4, uchar{1});
  view.mask.at<uchar>(0, 1) = 0;
  Params params;
  params.distinctiveness = Distinctiveness::none;
  EXPECT_EQ(unpack(make_features(view, params), 1, 0)[3], 0);
  EXPECT_EQ(unpack(make_features(view, params), 0, 1)[3], 1);
  params.use_mask = false;
  EXPECT_EQ(unpack(make_features(view, params), 1, 0)[3], 1);
}

}  // namespace
}  // namespace hypotrack::stereo_color
