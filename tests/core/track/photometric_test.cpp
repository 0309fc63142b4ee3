#include "track/color/photometric.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "painted_box.hpp"
#include "shiny_ball.hpp"

namespace hypotrack {
namespace {

/// The map that a match puts on the second view, at a level.
double mapped(const PhotometricMatch& match, TilePlan plan, double level, int channel = 0) {
  match.apply(plan);
  const ColorMap& map = plan.views[1].colors;
  return map.gain[channel] * level + map.offset[channel];
}

struct MatchedBox : test::PaintedBox {
  Frame plain = frame();
  TilePlan plan = tiles->plan(plain, state());
  PhotometricSettings settings;

  void learn(PhotometricMatch& match, const Frame& frame, double x = 0) const {
    match.learn(*tiles, frame, plan, state(x));
  }
};

TEST(ColorSampler, TakesWhatBothViewsShowOfTheSurface) {
  const MatchedBox fixture;
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
  const MatchedBox fixture;
  ColorSampler sampler(fixture.scene);
  sampler.draw(fixture.plan.header, fixture.state());
  for (std::size_t i = 0; i < 2; ++i) {
    Frame frame = fixture.frame();
    frame.views[i].color = cv::Mat();
    EXPECT_EQ(sampler.take(frame, fixture.tiles->resamplers(), 1).size(), 0u);
  }
}

TEST(PhotometricMatch, LearnsFromPicturesAsTheyWereWhateverBecomesOfThem) {
  const MatchedBox fixture;
  const auto learned_with = [&](int threads) {
    PhotometricMatch match(fixture.scene, fixture.settings);
    tbb::task_arena(threads).execute([&] {
      constexpr int kFrames = 20;
      for (int i = 0; i < kFrames; ++i) {
        Frame frame = fixture.frame(1.05 + 0.01 * (i % 3), 3);
        fixture.learn(match, frame);
        for (View& view : frame.views) view.color.setTo(cv::Scalar(255, 0, 128));
      }
    });
    return match.colors(1);
  };
  const ColorMap one = learned_with(1), several = learned_with(4);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(one.gain[i], several.gain[i]) << i;
    EXPECT_EQ(one.offset[i], several.offset[i]) << i;
    EXPECT_NE(one.gain[i], 1) << i;
  }
}

TEST(PhotometricMatch, BringsTheSecondViewsColoursToTheFirsts) {
  const MatchedBox fixture;
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
  const MatchedBox fixture;
  const Frame frame = fixture.frame(1.15, 0);
  PhotometricMatch match(fixture.scene, fixture.settings);
  fixture.learn(match, frame);
  TilePlan plan = fixture.plan;
  match.apply(plan);
  const Observation as_they_are = fixture.tiles->resample(frame, fixture.plan);
  const Observation matched = fixture.tiles->resample(frame, plan);
  EXPECT_EQ(cv::norm(as_they_are.views[0].color, matched.views[0].color, cv::NORM_INF), 0);
  const cv::Rect middle(48, 48, 32, 32);
  const double left = cv::mean(matched.views[0].color(middle))[1];
  EXPECT_GT(cv::mean(as_they_are.views[1].color(middle))[1], left + 8);
  EXPECT_NEAR(cv::mean(matched.views[1].color(middle))[1], left, 2.5);
}

TEST(PhotometricMatch, SaysHowFarColoursStayApart) {
  const MatchedBox fixture;
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
    EXPECT_EQ(plan.header.context.color_difference, 0);
    fixture.learn(match, frame);
    match.apply(plan);
    EXPECT_EQ(fixture.tiles->resample(frame, plan).context.color_difference,
              plan.header.context.color_difference);
    return plan.header.context.color_difference;
  };
  const double without = difference(1, 0, 0);
  EXPECT_LT(without, 2.0 / 255);
  EXPECT_NEAR(difference(1.05, 3, 0), without, 1.0 / 255);
  EXPECT_GT(difference(1, 0, 6), 5.0 / 255);
  EXPECT_LT(difference(1, 0, 6), 20.0 / 255);
}

TEST(PhotometricMatch, ToleratesAPoseThatIsAFewMillimetresOff) {
  const MatchedBox fixture;
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

TEST(PhotometricMatch, BeginsWithWhatAStartThatIsNearlyRightShows) {
  const MatchedBox fixture;
  const Frame frame = fixture.frame(0.87, 0);
  PhotometricMatch begun(fixture.scene, fixture.settings), learned(fixture.scene, fixture.settings);
  begun.begin(*fixture.tiles, frame, fixture.plan, fixture.state());
  fixture.learn(learned, frame);
  EXPECT_TRUE(begun.knows());
  for (const double level : {70, 192}) {
    EXPECT_EQ(mapped(begun, fixture.plan, level), mapped(learned, fixture.plan, level));
  }
}

TEST(PhotometricMatch, FollowsExposuresThatChange) {
  const MatchedBox fixture;
  PhotometricMatch match(fixture.scene, fixture.settings);
  fixture.learn(match, fixture.frame(1.1, 4));
  const std::array<float, 2> gains{0.9F, 0.8F};
  match.follow(gains);
  for (const double level : {70, 110, 150})
    EXPECT_NEAR(mapped(match, fixture.plan, 0.8 * (1.1 * level + 4)), 0.9 * level, 1);
}

TEST(PhotometricMatch, BeginsAnewAfterItWasToldToForget) {
  const MatchedBox fixture;
  PhotometricMatch match(fixture.scene, fixture.settings), fresh(fixture.scene, fixture.settings);
  fixture.learn(match, fixture.frame(1.05, 3));
  match.forget();
  EXPECT_FALSE(match.knows());
  fixture.learn(match, fixture.frame(0.87, 0));
  fixture.learn(fresh, fixture.frame(0.87, 0));
  EXPECT_EQ(mapped(match, fixture.plan, 120), mapped(fresh, fixture.plan, 120));
}

TEST(PhotometricMatch, BeginsWithThePicturesWhereTheStartIsFarOff) {
  const MatchedBox fixture;
  const Frame frame = fixture.frame(0.87, 0);
  Eigen::VectorXd far = fixture.state();
  far.z() -= 0.12;
  PhotometricMatch match(fixture.scene, fixture.settings);
  match.begin(*fixture.tiles, frame, fixture.plan, far);
  EXPECT_FALSE(match.knows()) << "no solution has taught anything";
  for (const double level : {80, 110, 140}) {
    EXPECT_NEAR(mapped(match, fixture.plan, 0.87 * level), level, 3);
  }
  fixture.learn(match, fixture.frame(1.05, 3));
  EXPECT_TRUE(match.knows());
  for (const double level : {80, 110, 140}) {
    EXPECT_NEAR(mapped(match, fixture.plan, 1.05 * level + 3), level, 1)
        << "the first counts fully";
  }
}

TEST(PhotometricMatch, LearnsNothingWhereTheViewsShowSomethingElse) {
  const MatchedBox fixture;
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
  const MatchedBox fixture;
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

TEST(ColorSampler, TellsNormalsOfTheSurfaceInTheWorld) {
  const test::ShinyBall ball;
  ColorSampler sampler(ball.scene);
  const Frame frame = ball.frame(0);
  const TilePlan plan = ball.tiles->plan(frame, ball.state());
  sampler.draw(plan.header, ball.state());
  const ColorSamples samples = sampler.take(frame, ball.tiles->resamplers(), 1, true);
  ASSERT_GT(samples.size(), 300u);
  ASSERT_EQ(samples.normals.cols(), static_cast<Eigen::Index>(samples.size()));
  for (std::size_t view = 0; view < 2; ++view) {
    const ColorSampler::NormalGrid grid = sampler.normals(view);
    ASSERT_EQ(grid.normals.cols(), cv::countNonZero(grid.inside));
    const TileCamera& tile = plan.header.views[view].camera;
    Eigen::Index next = 0;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        if (grid.inside.at<unsigned char>(y, x) == 0) continue;
        // Where the ray through the grid's point meets the ball.
        const Eigen::Vector3d ray =
            Eigen::Vector3d((2 * x + 0.5 - tile.cx) / tile.fx, (2 * y + 0.5 - tile.cy) / tile.fy, 1)
                .normalized();
        const Eigen::Vector3d off = -(tile.camera_from_world * ball.state().head<3>());
        const double half = ray.dot(off);
        const double root = std::sqrt(half * half - off.squaredNorm() + 0.0025);
        const Eigen::Vector3d normal =
            tile.camera_from_world.linear().transpose() * (off - (half + root) * ray) / 0.05;
        const double cosine = normal.dot(grid.normals.col(next++).cast<double>());
        ASSERT_GT(cosine, std::cos(normal.z() < -0.7 ? 0.12 : 0.3)) << view << " " << x << " " << y;
      }
    }
  }
}

TEST(ColorSampler, TilesShowWhatTheImagesShow) {
  const test::ShinyBall ball;
  const Frame frame = ball.frame(60);
  const TilePlan plan = ball.tiles->plan(frame, ball.state());
  ColorSampler sampler(ball.scene);
  sampler.draw(plan.header, ball.state());
  const ColorSamples images = sampler.take(frame, ball.tiles->resamplers(), 1, true);
  const ColorSamples tiles = sampler.take(ball.tiles->resample(frame, plan), 1, true);
  ASSERT_EQ(tiles.size(), images.size());
  ASSERT_GT(tiles.size(), 200u);
  EXPECT_EQ(tiles.normals, images.normals);
  const auto mean_difference = [&](const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
    return sum / static_cast<double>(a.size());
  };
  EXPECT_LT(mean_difference(tiles.first[1], images.first[1]), 1);
  EXPECT_LT(mean_difference(tiles.other[1], images.other[1]), 1);
}

/// Mean absolute difference of the two tiles of a shiny ball, at its points.
double difference_of_tiles(const PhotometricSettings& settings, double strength) {
  const test::ShinyBall ball;
  const Frame frame = ball.frame(strength);
  PhotometricMatch match(ball.scene, settings);
  TilePlan plan = ball.tiles->plan(frame, ball.state());
  for (int i = 0; i < 5; ++i) match.learn(*ball.tiles, frame, plan, ball.state());
  match.apply(plan);
  match.apply_highlights(plan, ball.state());
  const Observation seen = ball.tiles->resample(frame, plan);
  ColorSampler sampler(ball.scene);
  sampler.draw(plan.header, ball.state());
  const ColorSamples samples = sampler.take(seen, 1);
  double sum = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    sum += std::abs(samples.first[1][i] - samples.other[1][i]);
  return sum / static_cast<double>(samples.size());
}

TEST(PhotometricMatch, TakesHighlightsOffWhereItIsToldTo) {
  const PhotometricSettings without, with{.highlights = true};
  const double diffuse = difference_of_tiles(without, 0);
  const double shiny = difference_of_tiles(without, 60);
  EXPECT_GT(shiny, diffuse + 2);
  EXPECT_LT(difference_of_tiles(with, 60), diffuse + 0.3 * (shiny - diffuse));
  EXPECT_LT(difference_of_tiles(with, 0), diffuse + 0.2);
}

TEST(PhotometricMatch, LeavesTheFirstViewsTileAsItIs) {
  const test::ShinyBall ball;
  const Frame frame = ball.frame(60);
  PhotometricMatch match(ball.scene, {.highlights = true});
  const TilePlan plain = ball.tiles->plan(frame, ball.state());
  TilePlan plan = plain;
  match.apply_highlights(plan, ball.state());
  EXPECT_TRUE(plan.views[1].brightness.empty()) << "before it has learned";
  match.learn(*ball.tiles, frame, plan, ball.state());
  match.apply_highlights(plan, ball.state());
  EXPECT_TRUE(plan.views[0].brightness.empty());
  EXPECT_FALSE(plan.views[1].brightness.empty());
  EXPECT_EQ(cv::norm(ball.tiles->resample(frame, plain).views[0].color,
                     ball.tiles->resample(frame, plan).views[0].color, cv::NORM_INF),
            0);
}

TEST(PhotometricMatch, OffLeavesColoursAlone) {
  MatchedBox fixture;
  fixture.settings.match = false;
  PhotometricMatch match(fixture.scene, fixture.settings);
  fixture.learn(match, fixture.frame(1.05, 3));
  EXPECT_FALSE(match.knows());
  TilePlan plan = fixture.plan;
  match.apply(plan);
  EXPECT_TRUE(keeps_colors(plan.views[1].colors));
  EXPECT_EQ(plan.header.context.color_difference, 0);
}

TEST(PhotometricMatch, HasNothingToDoWithOneView) {
  const MatchedBox fixture;
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
