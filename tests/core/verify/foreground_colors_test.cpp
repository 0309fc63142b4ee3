#include "track/verify/foreground_colors.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace hypotrack {
namespace {

/// A disc of one colour before another.
SurfaceSamples disc(const cv::Scalar& inside, const cv::Scalar& outside) {
  SurfaceSamples out;
  for (SampledView& view : out.views) {
    view.color = cv::Mat3f(kSampleGrid, kSampleGrid);
    view.color.setTo(outside);
    view.inside = cv::Mat1b(kSampleGrid, kSampleGrid, uchar{0});
    cv::circle(view.inside, {32, 32}, 16, 255, cv::FILLED);
    view.color.setTo(inside, view.inside);
    cv::bitwise_not(view.inside, view.ring);
  }
  return out;
}

constexpr float kNoIdea = 0.5f;
const cv::Vec3f kSkin(110, 140, 200), kGreen(80, 160, 60);

TEST(ForegroundColors, KnowNothingAtFirst) {
  const ForegroundColors colors;
  EXPECT_FALSE(colors.known());
  EXPECT_EQ(colors.probability(kSkin), kNoIdea);
}

TEST(ForegroundColors, ExpectASurfaceInAnyLightBeforeOtherColours) {
  ForegroundColors colors;
  const std::vector<cv::Vec3f> surface{kSkin};
  const std::vector<cv::Mat3b> pictures{cv::Mat3b(40, 60, cv::Vec3b(80, 160, 60))};
  colors.expect(surface, pictures);
  ASSERT_TRUE(colors.known());
  EXPECT_GT(colors.probability(kSkin), 0.9f);
  EXPECT_GT(colors.probability(0.5f * kSkin), 0.9f);
  EXPECT_LT(colors.probability(kGreen), 0.1f);
}

TEST(ForegroundColors, TellTheModelFromWhatIsBesideIt) {
  ForegroundColors colors;
  colors.learn(disc(kSkin, kGreen));
  EXPECT_GT(colors.probability(kSkin), 0.9f);
  EXPECT_LT(colors.probability(kGreen), 0.1f);
}

TEST(ForegroundColors, KnowTheModelInOtherLight) {
  ForegroundColors colors;
  colors.learn(disc(kSkin, kGreen));
  EXPECT_GT(colors.probability(0.85f * kSkin), 0.8f);
}

TEST(ForegroundColors, TakeAColorThatWasNeverSeenForBackground) {
  ForegroundColors colors;
  colors.learn(disc(kSkin, kGreen));
  EXPECT_LT(colors.probability({220, 30, 30}), 0.2f);
}

TEST(ForegroundColors, ForgetOldFramesInTime) {
  ForegroundColors colors;
  colors.learn(disc(kSkin, kGreen));
  for (int i = 0; i < 60; ++i) colors.learn(disc(kGreen, kSkin));
  EXPECT_LT(colors.probability(kSkin), 0.2f);
  EXPECT_GT(colors.probability(kGreen), 0.8f);
}

}  // namespace
}  // namespace hypotrack
