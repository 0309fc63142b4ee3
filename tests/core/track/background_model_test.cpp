#include "track/color/background_model.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <vector>

#include "every_target.hpp"
#include "scene/simd_kernels.hpp"

namespace hypotrack {
namespace {

/// A still background of stripes with noise, and a disc before it.
cv::Mat3b picture(int seed, bool with_disc, int moved = 0) {
  cv::Mat3b out(60, 80, cv::Vec3b(90, 120, 150));
  for (int x = 0; x < out.cols; x += 10)
    out.colRange((x + moved) % 76, (x + moved) % 76 + 4).setTo(cv::Scalar(60, 60, 120));
  if (with_disc) cv::circle(out, {40, 30}, 10, {110, 140, 200}, cv::FILLED);
  cv::Mat3b noise(out.size());
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(noise, cv::RNG::UNIFORM, 0, 3);
  return out + noise;
}

cv::Mat1b disc() {
  cv::Mat1b out(60, 80, uchar{0});
  cv::circle(out, {40, 30}, 10, 255, cv::FILLED);
  return out;
}

TEST(BackgroundModel, TellsWhatIsNewFromWhatWasThere) {
  BackgroundModel background;
  for (int i = 0; i < 8; ++i) background.learn(picture(i, false), {});
  const cv::Mat1f changed = background.changed(picture(9, true));
  EXPECT_GT(cv::mean(changed, disc())[0], 0.9);
  EXPECT_LT(cv::mean(changed, ~disc())[0], 0.2);
}

TEST(BackgroundModel, DoesNotLearnTheForeground) {
  BackgroundModel background;
  for (int i = 0; i < 8; ++i) background.learn(picture(i, true), disc());
  EXPECT_GT(cv::mean(background.changed(picture(9, true)), disc())[0], 0.99);
}

TEST(BackgroundModel, SaysNothingBeforeItLearnedOrOfWhatMoved) {
  BackgroundModel background;
  EXPECT_EQ(cv::mean(background.changed(picture(0, true)))[0], 1);
  background.learn(picture(0, false), {});
  EXPECT_EQ(cv::mean(background.changed(picture(0, false)))[0], 1) << "it may move";
  for (int i = 0; i < 8; ++i) background.learn(picture(i, false), {});
  const cv::Mat1b stripes = [] {
    cv::Mat1b out(60, 80, uchar{0});
    for (int x = 0; x < 70; x += 10) out.colRange(x + 5, x + 9).setTo(255);
    return out;
  }();
  EXPECT_GT(cv::mean(background.changed(picture(0, false, 5)), stripes)[0], 0.9);
}

TEST(BackgroundModel, KeepsTheMeanWhereItIsKnown) {
  const cv::Rect part(30, 10, 47, 40);  // columns that fill no whole vectors
  BackgroundModel background;
  EXPECT_FALSE(background.has_learned());
  for (int i = 0; i < 30; ++i) background.learn(picture(i, false), disc());
  ASSERT_TRUE(background.has_learned());
  const cv::Mat4b known = background.background(part);
  const cv::Mat3b shown = picture(0, false)(part);
  const cv::Mat1b hidden = disc()(part);
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x) {
      ASSERT_EQ(known(y, x)[3], hidden(y, x) ? 0 : 255) << x << " " << y;
      for (int i = 0; i < 3 && !hidden(y, x); ++i)
        ASSERT_NEAR(known(y, x)[i], shown(y, x)[i], 2);  // the noise
    }
}

TEST(BackgroundModel, IsTheSameOnEveryInstructionSet) {
  const cv::Rect all(0, 0, 77, 60);  // columns that fill no whole vectors
  std::vector<cv::Mat4b> found;
  test::on_every_target(compiled_simd_targets(), [&] {
    BackgroundModel background;
    for (int i = 0; i < 12; ++i)
      background.learn(picture(i, i > 8)(all), i % 2 ? disc()(all) : cv::Mat1b());
    found.push_back(background.background(all));
  });
  for (const cv::Mat4b& one : found) EXPECT_EQ(cv::norm(one, found[0], cv::NORM_INF), 0);
}

}  // namespace
}  // namespace hypotrack
