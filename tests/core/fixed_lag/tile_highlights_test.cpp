#include "track/smooth/tile_highlights.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "hypotrack/plugin/objective.hpp"
#include "shiny_ball.hpp"
#include "track/smooth/fixed_lag_smoother.hpp"

namespace hypotrack {
namespace {

/// Frames of a ball, in the colours of the pictures.
struct BallFrames {
  explicit BallFrames(double strength) {
    for (int i = 0; i < 5; ++i) {
      const Frame frame = ball.frame(strength);
      seen.emplace_back(ball.tiles->resample(frame, ball.tiles->plan(frame, ball.state())));
      states.push_back({i / 30.0, ball.state()});
    }
  }

  /// Mean absolute difference of the views at the ball's points.
  double difference(const Observation& tiles) const {
    ColorSampler sampler(ball.scene);
    sampler.draw(tiles, ball.state());
    const ColorSamples samples = sampler.take(tiles, 1);
    double sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
      sum += std::abs(samples.first[1][i] - samples.other[1][i]);
    return sum / static_cast<double>(samples.size());
  }

  test::ShinyBall ball;
  std::vector<FrameTiles> seen;
  std::vector<TimedState> states;
};

TEST(TileHighlights, TakesOffWhatViewsDifferBy) {
  const BallFrames shiny(60), diffuse(0);
  TileHighlights highlights(shiny.ball.scene);
  highlights.learn(shiny.seen, shiny.states);
  const Observation off = highlights.off(*shiny.seen[2], shiny.ball.state());
  const double most = shiny.difference(*shiny.seen[2]),
               least = diffuse.difference(*diffuse.seen[2]);
  ASSERT_GT(most, least + 2);
  EXPECT_LT(shiny.difference(off), least + 0.3 * (most - least));
  EXPECT_EQ(cv::norm(off.views[0].color, shiny.seen[2]->views[0].color, cv::NORM_INF), 0);
}

TEST(TileHighlights, LeavesTilesWithoutThem) {
  const BallFrames diffuse(0);
  TileHighlights highlights(diffuse.ball.scene);
  highlights.learn(diffuse.seen, diffuse.states);
  const Observation off = highlights.off(*diffuse.seen[2], diffuse.ball.state());
  EXPECT_LT(diffuse.difference(off), diffuse.difference(*diffuse.seen[2]) + 0.2);
}

TEST(TileHighlights, LearnsAnewFromTheSameTiles) {
  const BallFrames shiny(60);
  TileHighlights once(shiny.ball.scene), again(shiny.ball.scene);
  once.learn(shiny.seen, shiny.states);
  for (int i = 0; i < 4; ++i) again.learn(shiny.seen, shiny.states);
  const double first = shiny.difference(once.off(*shiny.seen[0], shiny.ball.state()));
  const double later = shiny.difference(again.off(*shiny.seen[0], shiny.ball.state()));
  EXPECT_LT(later, 1.1 * first);
}

TEST(TileHighlights, LearnsNothingFromFramesThatWereNotSeenOrHaveNoColour) {
  BallFrames shiny(60);
  const Observation before = *shiny.seen[0];
  for (FrameTiles& tiles : shiny.seen) tiles.reset();
  shiny.seen[1] = before;
  for (TileView& view : shiny.seen[1]->views) view.color = cv::Mat();
  TileHighlights highlights(shiny.ball.scene);
  highlights.learn(shiny.seen, shiny.states);
  EXPECT_EQ(cv::norm(highlights.off(before, shiny.ball.state()).views[1].color,
                     before.views[1].color, cv::NORM_INF),
            0);
  EXPECT_TRUE(highlights.off(*shiny.seen[1], shiny.ball.state()).views[1].color.empty());
}

/// What the views that it is given differ by, in the mean over their tiles; every pose is as good
/// as another.
class Differing final : public Objective, public ResidualTerm {
 public:
  std::vector<double> differences;

 private:
  void do_prepare(const Observation& seen) override {
    const auto brightness = [&](std::size_t i) { return cv::mean(seen.views[i].color)[1]; };
    differences.push_back(brightness(1) - brightness(0));
  }
  double do_cost(const RenderedHypothesis&) const override { return 0; }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return 1; }
  void do_write_residuals(const RenderedHypothesis&, std::span<float> residuals) const override {
    residuals[0] = 0;
  }
};

TEST(FixedLagSmoother, LooksAtTilesWithoutHighlightsWhereItIsToldTo) {
  const BallFrames shiny(60);
  const auto first_difference = [&](bool highlights) {
    const auto objective = std::make_shared<Differing>();
    FixedLagSmoother smoother(shiny.ball.scene, {{1.0, objective}},
                              {.backend = Backend::cpu, .threads = 1}, {.evaluations = 100},
                              highlights);
    for (std::size_t i = 0; i < shiny.seen.size(); ++i)
      smoother.add(shiny.seen[i], shiny.states[i]);
    for (const FixedLagSmoother::Settled& one : smoother.finish()) EXPECT_LE(one.evaluations, 100);
    return objective->differences.front();
  };
  EXPECT_GT(std::abs(first_difference(true) - first_difference(false)), 0.1);
}

}  // namespace
}  // namespace hypotrack
