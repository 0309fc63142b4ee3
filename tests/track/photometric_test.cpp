#include "track/photometric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "painted_box.hpp"

namespace hypotrack {
namespace {

/// The map that a match puts on the second view, at a level.
double mapped(const PhotometricMatch& match, TilePlan plan, double level, int channel = 0) {
  match.apply(plan);
  const ColorMap& map = plan.cuts[1].colors;
  return map.gain[channel] * level + map.offset[channel];
}

struct Fixture : test::PaintedBox {
  Frame plain = frame();
  TilePlan plan = tiles->plan(plain, state());
  PhotometricSettings settings;

  void learn(PhotometricMatch& match, const Frame& frame, double x = 0) const {
    match.learn(*tiles, frame, plan, state(x));
  }
};

TEST(ColorSampler, TakesWhatBothViewsShowOfTheSurface) {
  const Fixture fixture;
  ColorSampler sampler(fixture.scene);
  sampler.draw(fixture.plan.header, fixture.state());
  const ColorSamples samples = sampler.take(fixture.plain, fixture.tiles->resamplers(), 1);
  ASSERT_GT(samples.size(), 500u);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(samples.other[i].size(), samples.size());
    for (std::size_t n = 0; n < samples.size(); ++n) {
      ASSERT_NEAR(samples.first[i][n], samples.other[i][n], 6) << n;
    }
  }
}

TEST(ColorSampler, TakesNothingFromViewsWithoutColour) {
  const Fixture fixture;
  ColorSampler sampler(fixture.scene);
  sampler.draw(fixture.plan.header, fixture.state());
  for (std::size_t i = 0; i < 2; ++i) {
    Frame frame = fixture.frame();
    frame.views[i].color = cv::Mat();
    EXPECT_EQ(sampler.take(frame, fixture.tiles->resamplers(), 1).size(), 0u);
  }
}

TEST(PhotometricMatch, BringsTheSecondViewsColoursToTheFirsts) {
  const Fixture fixture;
  const Frame frame = fixture.frame(1.05, 3);
  PhotometricMatch match(fixture.scene, fixture.settings);
  EXPECT_FALSE(match.knows());
  fixture.learn(match, frame);
  EXPECT_TRUE(match.knows());
  for (const double level : {70, 110, 150}) {
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(mapped(match, fixture.plan, 1.05 * level + 3, channel), level, 1) << channel;
    }
  }
}

TEST(PhotometricMatch, IsInTheTilesThatObjectivesSee) {
  const Fixture fixture;
  const Frame frame = fixture.frame(1.15, 0);
  PhotometricMatch match(fixture.scene, fixture.settings);
  fixture.learn(match, frame);
  TilePlan plan = fixture.plan;
  match.apply(plan);
  const Observation as_they_are = fixture.tiles->cut(frame, fixture.plan);
  const Observation matched = fixture.tiles->cut(frame, plan);
  EXPECT_EQ(cv::norm(as_they_are.views[0].color, matched.views[0].color, cv::NORM_INF), 0);
  const cv::Rect middle(48, 48, 32, 32);
  const double left = cv::mean(matched.views[0].color(middle))[1];
  EXPECT_GT(cv::mean(as_they_are.views[1].color(middle))[1], left + 8);
  EXPECT_NEAR(cv::mean(matched.views[1].color(middle))[1], left, 2.5);
}

TEST(PhotometricMatch, SaysHowFarColoursStayApart) {
  const Fixture fixture;
  const auto difference = [&](double gain, double offset, double noise) {
    Frame frame = fixture.frame(gain, offset);
    cv::RNG random(5);
    for (auto& view : frame.views) {
      cv::Mat3s added(view.color.size());
      random.fill(added, cv::RNG::NORMAL, 0, noise);
      cv::add(view.color, added, view.color, cv::noArray(), CV_8UC3);
    }
    PhotometricMatch match(fixture.scene, fixture.settings);
    TilePlan plan = fixture.plan;
    match.apply(plan);
    EXPECT_EQ(plan.header.color_difference, 0);
    fixture.learn(match, frame);
    match.apply(plan);
    EXPECT_EQ(fixture.tiles->cut(frame, plan).color_difference, plan.header.color_difference);
    return plan.header.color_difference;
  };
  const double without = difference(1, 0, 0);
  EXPECT_LT(without, 2.0 / 255);
  EXPECT_NEAR(difference(1.05, 3, 0), without, 1.0 / 255);
  EXPECT_GT(difference(1, 0, 6), 5.0 / 255);
  EXPECT_LT(difference(1, 0, 6), 20.0 / 255);
}

TEST(PhotometricMatch, ToleratesAPoseThatIsAFewMillimetresOff) {
  const Fixture fixture;
  const Frame frame = fixture.frame(0.87, 0);
  for (const double x : {-0.008, 0.008}) {
    PhotometricMatch match(fixture.scene, fixture.settings);
    fixture.learn(match, frame, x);
    ASSERT_TRUE(match.knows()) << x;
    for (const double level : {80, 110, 140}) {
      EXPECT_NEAR(mapped(match, fixture.plan, 0.87 * level), level, 3) << x;
    }
  }
}

TEST(PhotometricMatch, LearnsNothingWhereTheViewsShowSomethingElse) {
  const Fixture fixture;
  Frame frame = fixture.frame();
  cv::RNG(3).fill(frame.views[1].color, cv::RNG::UNIFORM, 20, 235);
  PhotometricMatch match(fixture.scene, fixture.settings);
  fixture.learn(match, frame);
  EXPECT_FALSE(match.knows());
  EXPECT_EQ(mapped(match, fixture.plan, 100), 100);

  fixture.learn(match, fixture.frame(1.05, 3));
  const double before = mapped(match, fixture.plan, 100);
  fixture.learn(match, frame);
  EXPECT_EQ(mapped(match, fixture.plan, 100), before);
}

TEST(PhotometricMatch, ChangesLittleFromFrameToFrameOnceItIsSettled) {
  const Fixture fixture;
  PhotometricMatch match(fixture.scene, fixture.settings);
  for (int i = 0; i < 4; ++i) fixture.learn(match, fixture.plain);
  const Frame brighter = fixture.frame(1.5, 0);
  double before = mapped(match, fixture.plan, 192);
  ASSERT_NEAR(before, 192, 1);
  for (int i = 0; i < 3; ++i) {
    fixture.learn(match, brighter);
    const double now = mapped(match, fixture.plan, 192);
    EXPECT_NEAR(now, before - fixture.settings.max_change, 1e-3) << i;
    before = now;
  }
  for (int i = 0; i < 40; ++i) fixture.learn(match, brighter);
  EXPECT_NEAR(mapped(match, fixture.plan, 192), 128, 2);
}

TEST(PhotometricMatch, OffLeavesColoursAlone) {
  Fixture fixture;
  fixture.settings.match = false;
  PhotometricMatch match(fixture.scene, fixture.settings);
  fixture.learn(match, fixture.frame(1.05, 3));
  EXPECT_FALSE(match.knows());
  TilePlan plan = fixture.plan;
  match.apply(plan);
  EXPECT_TRUE(keeps_colors(plan.cuts[1].colors));
  EXPECT_EQ(plan.header.color_difference, 0);
}

TEST(PhotometricMatch, HasNothingToDoWithOneView) {
  const Fixture fixture;
  const TileMaker tiles(fixture.scene, {fixture.cameras[0]}, {});
  Frame frame = fixture.frame();
  frame.views.resize(1);
  TilePlan plan = tiles.plan(frame, fixture.state());
  PhotometricMatch match(fixture.scene, fixture.settings);
  match.learn(tiles, frame, plan, fixture.state());
  EXPECT_FALSE(match.knows());
  match.apply(plan);
}

}  // namespace
}  // namespace hypotrack
