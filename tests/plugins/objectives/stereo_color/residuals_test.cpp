#include "residuals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "color_consistency-inl.hpp"
#include "every_target.hpp"
#include "hypotrack/plugin/stereo_pixels_map-inl.hpp"
#include "random_pair.hpp"
#include "stereo_color.hpp"
#include "written_residuals.hpp"

namespace hypotrack::stereo_color {
namespace {

// The same observation with nothing drawn.
double of_nothing(const StereoColor& objective, const RandomPair& pair) {
  DepthTile empty[2] = {pair.tiles[0], pair.tiles[1]};
  for (DepthTile& tile : empty) tile.x0 = tile.y0 = tile.x1 = tile.y1 = 0;
  return test::sum_of_squares(test::written_residuals(objective, {{}, empty}));
}

void expect_cost_as_squares(const PairOptions& options, const Params& params) {
  const RandomPair pair(options);
  StereoColor objective(params);
  objective.prepare(pair.observation);
  ASSERT_EQ(objective.residual_term(), &objective);
  on_every_target([&] {
    const double cost = objective.cost(pair.hypothesis());
    ASSERT_LT(cost, 0);
    const std::vector<float> all = test::written_residuals(objective, pair.hypothesis());
    const double squares = test::sum_of_squares(all);
    EXPECT_NEAR((squares - of_nothing(objective, pair)) / cost, 1, 1e-4);
  });
}

TEST(Residuals, SquaredAddUpToTheCostAndAConstantOfTheFrame) {
  for (const auto direction :
       {Direction::left_to_right, Direction::right_to_left, Direction::both}) {
    for (const auto lookup : {Lookup::nearest, Lookup::bilinear}) {
      for (const bool rectified : {true, false}) {
        SCOPED_TRACE(testing::Message()
                     << static_cast<int>(direction) << static_cast<int>(lookup) << rectified);
        Params params;
        params.beta = 20;
        params.direction = direction;
        params.lookup = lookup;
        expect_cost_as_squares({.rectified = rectified, .mask = true, .size = 96}, params);
      }
    }
  }
}

TEST(Residuals, SquaredAddUpToTheCostWithEveryFalloffAndCoveragePenalty) {
  for (const auto falloff : {Falloff::exponential, Falloff::gaussian}) {
    for (const double coverage_penalty : {0.0, 0.05}) {
      for (const auto direction : {Direction::left_to_right, Direction::both}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(falloff) << " " << coverage_penalty);
        Params params;
        params.beta = 5;
        params.falloff = falloff;
        params.coverage_penalty = coverage_penalty;
        params.direction = direction;
        params.lookup = Lookup::bilinear;
        expect_cost_as_squares({.mask = true, .size = 96}, params);
      }
    }
  }
}

TEST(Residuals, AreThereForEveryPixelOfTilesOfAnySize) {
  for (const int size : {16, 33, 50, 100}) {
    const RandomPair pair({.size = size, .stride_beyond = 3});
    Params params;
    params.direction = Direction::both;
    StereoColor objective(params);
    objective.prepare(pair.observation);
    EXPECT_EQ(objective.residual_count(), 2 * size * size);
    on_every_target([&] {
      for (const float r : test::written_residuals(objective, pair.hypothesis())) {
        EXPECT_TRUE(r >= 0 && r <= 1) << r;
      }
    });
  }
}

TEST(Residuals, OfOneDirectionAreThoseOfItsView) {
  const RandomPair pair({.size = 64});
  const auto of = [&](Direction direction) {
    Params params;
    params.direction = direction;
    StereoColor objective(params);
    objective.prepare(pair.observation);
    return test::written_residuals(objective, pair.hypothesis());
  };
  const auto left = of(Direction::left_to_right), right = of(Direction::right_to_left);
  const auto both = of(Direction::both);
  ASSERT_EQ(both.size(), left.size() + right.size());
  for (std::size_t i = 0; i < both.size(); ++i) {
    const float one = i < left.size() ? left[i] : right[i - left.size()];
    EXPECT_NEAR(both[i], one * std::sqrt(0.5), 1e-6);
  }
}

void expect_slopes_like_derivatives(Params params) {
  for (const bool rectified : {true, false}) {
    const RandomPair pair({.rectified = rectified, .size = 96});
    params.distinctiveness = Distinctiveness::none;
    params.r = 0.1;  // so generous that what is seen stays seen
    params.direction = Direction::both;
    params.lookup = Lookup::bilinear;
    StereoColor objective(params);
    objective.prepare(pair.observation);
    ASSERT_THAT(objective.pixel_views(), testing::ElementsAre(0, 1));
    const StereoMap map = stereo_map(pair.observation, 0, 1);
    // The inverse depth that makes so little parallax that the difference is a derivative.
    const auto step = [&](std::size_t i) {
      const auto x = static_cast<float>(i % 96), y = static_cast<float>(i / 96);
      const float w = pair.depth[0][i];
      const auto there = hypotrack::scalar::map_pixel<false>(map, x, y, w);
      const auto beyond = hypotrack::scalar::map_pixel<false>(map, x, y, w + 0.01f);
      return scalar::kSlopeReach * 0.01f / std::hypot(beyond.u - there.u, beyond.v - there.v);
    };
    const auto shifted = [&](float steps) {
      std::vector<float> depth[2] = {pair.depth[0], pair.depth[1]};
      for (std::size_t i = 0; i < depth[0].size(); ++i) {
        if (depth[0][i] > 0) depth[0][i] += steps * step(i);
      }
      DepthTile tiles[2] = {pair.tiles[0], pair.tiles[1]};
      for (std::size_t i = 0; i < 2; ++i) tiles[i].inverse_depth = depth[i].data();
      return test::written_residuals(objective, {{}, tiles});
    };
    on_every_target([&] {
      const auto near = shifted(1), far = shifted(-1);
      const auto expected = test::written_residuals(objective, pair.hypothesis());
      std::vector<float> found(96 * 96), slopes(found.size(), NAN);
      objective.write_slopes(pair.hypothesis(), 0, found, slopes);
      int compared = 0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i], expected[i], 1e-5);
        // What one view alone sees keeps its residual.
        const auto alone = [](float r) { return std::abs(r - std::sqrt(0.5f)) < 1e-4f; };
        if (slopes[i] == 0 || alone(near[i]) || alone(far[i])) continue;
        EXPECT_NEAR(slopes[i] * 2 * step(i), near[i] - far[i], 3e-4) << i;
        ++compared;
      }
      EXPECT_GT(compared, 1000);
    });
  }
}

TEST(Residuals, HaveSlopesThatAreTheirDerivativesByDepth) {
  Params params;
  params.beta = 3;
  expect_slopes_like_derivatives(params);
  params.falloff = Falloff::gaussian;
  expect_slopes_like_derivatives(params);
  params.coverage_penalty = 0.1;
  expect_slopes_like_derivatives(params);
}

TEST(Residuals, HaveNoSlopesWhereNothingIsSeenTwice) {
  const RandomPair pair({.size = 64});
  StereoColor objective({});
  objective.prepare(pair.observation);
  ASSERT_THAT(objective.pixel_views(), testing::ElementsAre(0));
  DepthTile tiles[2] = {pair.tiles[0], pair.tiles[1]};
  const std::vector<float> empty(pair.depth[1].size(), 0.0f);
  tiles[1].inverse_depth = empty.data();
  std::vector<float> found(64 * 64), slopes(found.size(), NAN);
  objective.write_slopes({{}, tiles}, 0, found, slopes);
  EXPECT_EQ(found, test::written_residuals(objective, {{}, tiles}));
  EXPECT_EQ(slopes, std::vector<float>(slopes.size(), 0.0f));
}

TEST(Residuals, AreOfferedForTheSumOnly) {
  for (const auto aggregation :
       {Aggregation::mean_seen, Aggregation::mean_rendered, Aggregation::sum_per_sqrt}) {
    Params params;
    params.aggregation = aggregation;
    EXPECT_EQ(StereoColor(params).residual_term(), nullptr);
  }
}

}  // namespace
}  // namespace hypotrack::stereo_color
