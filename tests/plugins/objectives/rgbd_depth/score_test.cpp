#include "score.hpp"

#include <gtest/gtest.h>

#include <random>

#include "depth_scene.hpp"
#include "every_target.hpp"
#include "reference.hpp"
#include "rgbd_depth.hpp"

namespace hypotrack::rgbd_depth {
namespace {

/// A random foreground with holes, and a hypothesis that agrees with a part of it.
struct RandomDepth {
  explicit RandomDepth(int size, int beyond = 0, std::uint32_t seed = 1, int views = 1) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    observation = blank_observation(size);
    observation.views.clear();
    std::vector<Grid> grids;
    for (int i = 0; i < views; ++i) {
      TileView& view = observation.views.emplace_back(blank_view(size));
      view.mask = cv::Mat1b(size, size, uchar{0});
      view.valid.colRange(0, size / 8).setTo(0);
      Grid& grid = grids.emplace_back(static_cast<std::size_t>(size) * size);
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
          const float z = 0.4f + 0.2f * uniform(rng);
          view.mask.at<uchar>(y, x) = uniform(rng) < 0.6f ? 255 : 0;
          if (uniform(rng) < 0.9f) view.depth.at<float>(y, x) = z;
          const bool inside = x > size / 6 && y > size / 5 && y < size - 2;
          const float off = (uniform(rng) < 0.7f ? 0.03f : 0.2f) * (uniform(rng) - 0.5f);
          if (inside && uniform(rng) < 0.8f) grid[static_cast<std::size_t>(y * size + x)] = z + off;
        }
      }
    }
    drawn = std::make_unique<Drawn>(grids, size, beyond);
  }
  Observation observation;
  std::unique_ptr<Drawn> drawn;
};

double fast(const RandomDepth& random, const Params& params) {
  RgbdDepth objective(params);
  objective.prepare(random.observation);
  return objective.cost(random.drawn->hypothesis());
}

void expect_like_reference(const RandomDepth& random, const Params& params = {}) {
  const double expected = reference::cost(random.observation, random.drawn->hypothesis(), params);
  ASSERT_GT(expected, 1);
  test::on_every_target(compiled_targets(),
                        [&] { EXPECT_NEAR(fast(random, params) / expected, 1, 1e-5); });
}

TEST(Score, IsTheReferences) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) expect_like_reference(RandomDepth(128, 0, seed));
}

TEST(Score, IsTheReferencesForOddSizesAndStrides) {
  for (const int size : {5, 9, 17, 31, 33, 77}) {
    for (const int beyond : {0, 3, 16}) {
      SCOPED_TRACE(testing::Message() << size << " + " << beyond);
      expect_like_reference(RandomDepth(size, beyond));
    }
  }
}

TEST(Score, IsTheReferencesForSeveralViewsAndOtherParameters) {
  Params params;
  params.d_max = 0.08;
  params.d_match = 0.004;
  params.lambda = 7;
  expect_like_reference(RandomDepth(64, 0, 4, 3), params);
}

TEST(Score, CountsTheSameOnEveryInstructionSet) {
  const RandomDepth random(96);
  const ObservedView view = observe(random.observation.views[0], Foreground::mask, {});
  const auto run = [&] { return compare(view.pixels, random.drawn->tile(0), 0.04f, 0.01f); };
  const Agreement best = run();
  EXPECT_GT(best.matched, 1000);
  EXPECT_GT(best.beyond, 1000);
  test::on_every_target(compiled_targets(), [&] {
    const Agreement a = run();
    EXPECT_EQ(a.matched, best.matched);
    EXPECT_EQ(a.beyond, best.beyond);
    EXPECT_NEAR(a.closeness / best.closeness, 1, 1e-6);
  });
}

TEST(Score, IsBitIdenticalForEqualInputs) {
  EXPECT_EQ(fast(RandomDepth(64), {}), fast(RandomDepth(64), {}));
}

}  // namespace
}  // namespace hypotrack::rgbd_depth
