#include "score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "every_target.hpp"
#include "random_pair.hpp"
#include "reference.hpp"
#include "stereo_color.hpp"

namespace hypotrack::stereo_color {
namespace {

double fast(const RandomPair& pair, const Params& params) {
  StereoColor objective(params);
  objective.prepare(pair.observation);
  return objective.cost(pair.hypothesis());
}

void expect_like_reference(const PairOptions& options, const Params& params) {
  const RandomPair pair(options);
  const double expected = reference::cost(pair.observation, pair.hypothesis(), params);
  ASSERT_LT(expected, 0);
  on_every_target([&] { EXPECT_NEAR(fast(pair, params) / expected, 1, 1e-3); });
}

TEST(Score, IsTheReferencesForRectifiedPairs) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) expect_like_reference({.seed = seed}, {});
}

TEST(Score, IsTheReferencesForGeneralPairs) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    expect_like_reference({.rectified = false, .seed = seed}, {});
  }
}

TEST(Score, IsTheReferencesInBothDirectionsAndLookups) {
  for (const auto direction :
       {Direction::left_to_right, Direction::right_to_left, Direction::both}) {
    for (const auto lookup : {Lookup::nearest, Lookup::bilinear}) {
      for (const bool rectified : {true, false}) {
        SCOPED_TRACE(testing::Message()
                     << static_cast<int>(direction) << static_cast<int>(lookup) << rectified);
        Params params;
        params.direction = direction;
        params.lookup = lookup;
        expect_like_reference({.rectified = rectified, .mask = true, .size = 96}, params);
      }
    }
  }
}

TEST(Score, IsTheReferencesForEveryAggregation) {
  for (const auto aggregation : {Aggregation::sum, Aggregation::mean_seen,
                                 Aggregation::mean_rendered, Aggregation::sum_per_sqrt}) {
    SCOPED_TRACE(static_cast<int>(aggregation));
    Params params;
    params.aggregation = aggregation;
    expect_like_reference({.size = 96}, params);
  }
}

TEST(Score, IsTheReferencesForOtherParameters) {
  Params params;
  params.beta = 25;
  params.r = 1.5 * kMillimetre;
  params.w_t = 0.25;
  expect_like_reference({.seed = 7}, params);
  params.distinctiveness = Distinctiveness::none;
  expect_like_reference({.seed = 8}, params);
  params.use_mask = false;
  expect_like_reference({.mask = true, .seed = 9}, params);
  params.color_space = ColorSpace::gray;
  expect_like_reference({.seed = 10}, params);
}

TEST(Score, IsTheReferencesForEveryFalloffAndCoveragePenalty) {
  for (const auto falloff : {Falloff::exponential, Falloff::gaussian}) {
    for (const double coverage_penalty : {0.0, 0.1}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(falloff) << " " << coverage_penalty);
      Params params;
      params.beta = 10;
      params.falloff = falloff;
      params.coverage_penalty = coverage_penalty;
      expect_like_reference({.size = 96}, params);
    }
  }
}

TEST(Score, IsTheReferencesForEveryGrayWeight) {
  for (const double weight : {0.0, 0.5}) {
    SCOPED_TRACE(weight);
    Params params;
    params.beta = 10;
    params.gray_weight = weight;
    expect_like_reference({.size = 96}, params);
  }
}

TEST(Score, IsTheReferencesForOddSizesAndStrides) {
  for (const int size : {9, 17, 31, 33, 77}) {
    for (const int beyond : {0, 3, 16}) {
      for (const bool rectified : {true, false}) {
        SCOPED_TRACE(testing::Message() << size << " + " << beyond << " " << rectified);
        Params params;
        params.w_t = 0;
        params.lookup = Lookup::bilinear;
        expect_like_reference({.rectified = rectified, .size = size, .stride_beyond = beyond},
                              params);
      }
    }
  }
}

TEST(Score, DoesNotDependOnTheInstructionSet) {
  for (const bool rectified : {true, false}) {
    const RandomPair pair({.rectified = rectified, .seed = 4});
    const double best = fast(pair, {});
    // One point that lands on the border of two pixels is worth up to about 3e-4 here.
    on_every_target([&] { EXPECT_NEAR(fast(pair, {}) / best, 1, 5e-4); });
  }
}

TEST(Score, OfARectifiedPairIsThatOfTheSamePairTreatedAsGeneral) {
  for (const auto lookup : {Lookup::nearest, Lookup::bilinear}) {
    RandomPair pair({.mask = true, .seed = 11});
    Params params;
    params.lookup = lookup;
    const double special = fast(pair, params);
    pair.observation.rectified = false;
    EXPECT_NEAR(fast(pair, params) / special, 1, 1e-3);
  }
}

TEST(Score, CountsSeenAndRenderedPixels) {
  const RandomPair pair({});
  const auto& views = pair.observation.views;
  const Features features[] = {make_features(views[0], {}), make_features(views[1], {})};
  int covered = 0;
  for (const float w : pair.depth[0]) covered += w > 0;
  on_every_target([&] {
    const Similarity s = measure({features[0], pair.tiles[0]}, {features[1], pair.tiles[1]},
                                 stereo_map(pair.observation, 0, 1), {});
    EXPECT_EQ(s.rendered, covered);
    EXPECT_GT(s.seen, covered / 3);
    EXPECT_LT(s.seen, covered);
  });
}

// Two flat tiles of one colour each facing each other; C = 1 everywhere.
struct FlatPair {
  explicit FlatPair(uchar difference) : depth(32 * 32, 2.0f) {
    observation.rectified = true;
    for (int i = 0; i < 2; ++i) {
      TileView view;
      view.camera = {32, 32, 100, 100, 16, 16, Eigen::Isometry3d::Identity()};
      view.color = cv::Mat3b(32, 32, cv::Vec3b::all(static_cast<uchar>(100 + i * difference)));
      view.valid = cv::Mat1b(32, 32, uchar{255});
      observation.views.push_back(view);
      tiles[i] = {32, 32, 32, depth.data(), 0, 0, 32, 32};
    }
    observation.views[1].camera.camera_from_world.translation().x() = -0.05;  // 10 px at 0.5 m
  }
  Observation observation;
  std::vector<float> depth;
  DepthTile tiles[2];
  RenderedHypothesis hypothesis() const { return {{}, tiles}; }
};

double flat_cost(const FlatPair& pair, Aggregation aggregation) {
  Params params;
  params.distinctiveness = Distinctiveness::none;
  params.aggregation = aggregation;
  StereoColor objective(params);
  objective.prepare(pair.observation);
  return objective.cost(pair.hypothesis());
}

TEST(Score, OfFlatTilesIsCountedByHand) {
  const FlatPair pair(3);
  // The ten leftmost columns fall out of the right tile; elsewhere ||dI|| = sqrt(3) * 3 / 255.
  const double s = std::exp(-100 * std::sqrt(3.0) * 3 / 255), seen = 22 * 32, rendered = 32 * 32;
  EXPECT_NEAR(flat_cost(pair, Aggregation::sum), -s * seen, 1e-4 * s * seen);
  EXPECT_NEAR(flat_cost(pair, Aggregation::mean_seen), -s, 1e-4 * s);
  EXPECT_NEAR(flat_cost(pair, Aggregation::mean_rendered), -s * seen / rendered, 1e-4 * s);
  EXPECT_NEAR(flat_cost(pair, Aggregation::sum_per_sqrt), -s * seen / 32, 1e-4 * s * seen / 32);
}

TEST(Score, OfPixelsLessAlikeThanTheCoveragePenaltyIsACost) {
  const FlatPair pair(3);
  Params params;
  params.distinctiveness = Distinctiveness::none;
  const double s = std::exp(-100 * std::sqrt(3.0) * 3 / 255), seen = 22 * 32;
  for (const double coverage_penalty : {s / 2, s, 2 * s}) {
    params.coverage_penalty = coverage_penalty;
    StereoColor objective(params);
    objective.prepare(pair.observation);
    EXPECT_NEAR(objective.cost(pair.hypothesis()), (coverage_penalty - s) * seen, 1e-4 * s * seen);
  }
}

TEST(Score, OfNothingRenderedIsZero) {
  FlatPair pair(0);
  pair.depth.assign(pair.depth.size(), 0.0f);
  for (DepthTile& tile : pair.tiles) tile.x0 = tile.y0 = tile.x1 = tile.y1 = 0;
  for (const auto aggregation : {Aggregation::sum, Aggregation::mean_seen,
                                 Aggregation::mean_rendered, Aggregation::sum_per_sqrt}) {
    EXPECT_EQ(flat_cost(pair, aggregation), 0);
  }
}

TEST(Score, IsBitIdenticalForEqualInputs) {
  const RandomPair a({.mask = true}), b({.mask = true});
  EXPECT_EQ(fast(a, {}), fast(b, {}));
}

}  // namespace
}  // namespace hypotrack::stereo_color
