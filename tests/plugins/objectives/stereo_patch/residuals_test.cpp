#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "every_kernel_target.hpp"
#include "patch_pair.hpp"
#include "score.hpp"
#include "settings.hpp"
#include "stereo_patch.hpp"
#include "volume_kernel.hpp"
#include "written_residuals.hpp"

namespace hypotrack::stereo_patch {
namespace {

void expect_cost_as_squares(const PatchPair& pair, const Params& params) {
  on_every_target([&] {
    StereoPatch objective(params);
    objective.prepare(pair.observation);
    ASSERT_EQ(objective.residual_term(), &objective);
    const double cost = objective.cost(pair.hypothesis());
    ASSERT_LT(cost, 0);
    const TileView& view = pair.observation.views[0];
    const double counting =
        share_of(params, pair.observation) *
        cv::countNonZero(view.mask.empty() ? view.valid : cv::Mat(view.valid & view.mask));
    const double squares =
        test::sum_of_squares(test::written_residuals(objective, pair.hypothesis()));
    EXPECT_NEAR((squares - counting) / cost, 1, 1e-4);
  });
}

TEST(PatchResiduals, SquaredAreTheCostPlusTheNumberOfPixelsThatCount) {
  for (const auto measure : {Measure::zncc, Measure::census}) {
    for (const bool rectified : {true, false}) {
      for (const bool mask : {true, false}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(measure) << rectified << mask);
        Params params;
        params.measure = measure;
        expect_cost_as_squares(PatchPair({.rectified = rectified, .mask = mask, .size = 64}, true),
                               params);
      }
    }
  }
}

TEST(PatchResiduals, SquaredAreTheCostWherePixelsCountForAPartOnly) {
  PatchPair pair({.mask = true, .size = 64}, true);
  pair.observation.context.color_difference = 0.01;
  Params params;
  params.full_at_difference = 0.02;
  ASSERT_LT(share_of(params, pair.observation), 0.3);
  expect_cost_as_squares(pair, params);
}

TEST(PatchResiduals, AreThereForEveryPixelOfTilesOfAnySize) {
  for (const int size : {16, 33, 50, 100}) {
    const PatchPair pair({.size = size, .stride_beyond = 3}, true);
    on_every_target([&] {
      StereoPatch objective({});
      objective.prepare(pair.observation);
      EXPECT_EQ(objective.residual_count(), size * size);
      for (const float r : test::written_residuals(objective, pair.hypothesis())) {
        EXPECT_TRUE(r >= 0 && r <= 1) << r;
      }
    });
  }
}

TEST(PatchResiduals, OfPixelsThatNothingCoversAreOneWithinImageAndMask) {
  PatchPair pair({.mask = true, .size = 32}, true);
  StereoPatch objective({});
  objective.prepare(pair.observation);
  for (DepthTile& tile : pair.tiles) tile.x0 = tile.y0 = tile.x1 = tile.y1 = 0;
  const std::vector<float> found = test::written_residuals(objective, pair.hypothesis());
  const TileView& view = pair.observation.views[0];
  const cv::Mat1b counting = view.valid & view.mask;
  ASSERT_LT(cv::countNonZero(counting), cv::countNonZero(view.mask));
  for (int i = 0; i < 32 * 32; ++i) {
    EXPECT_EQ(found[static_cast<std::size_t>(i)], counting(i / 32, i % 32) ? 1.0f : 0.0f);
  }
}

TEST(PatchResiduals, HaveSlopesThatAreTheirDifferencesOverDepth) {
  for (const bool rectified : {true, false}) {
    PatchPair pair({.rectified = rectified, .size = 64}, true);
    pair.observation.context.color_difference = 0.01;
    Params params;
    params.full_at_difference = 0.011;
    params.r = 0.1;  // so generous that what is seen stays seen
    StereoPatch objective(params);
    objective.prepare(pair.observation);
    ASSERT_TRUE(objective.has_slopes());
    ASSERT_THAT(objective.pixel_views(), testing::ElementsAre(0));
    const float step = planes_around(pair.observation, params).step;
    const auto unseen = std::sqrt(static_cast<float>(share_of(params, pair.observation)));
    ASSERT_LT(unseen, 1);
    const auto nearer = [&](float planes) {
      std::vector<float> depth[2] = {pair.depth[0], pair.depth[1]};
      for (float& w : depth[0]) w += w > 0 ? planes * step : 0;
      DepthTile tiles[2] = {pair.tiles[0], pair.tiles[1]};
      for (std::size_t i = 0; i < 2; ++i) tiles[i].inverse_depth = depth[i].data();
      return test::written_residuals(objective, {{}, tiles});
    };
    on_every_target([&] {
      const auto expected = test::written_residuals(objective, pair.hypothesis());
      const auto near = nearer(0.5f), far = nearer(-0.5f);
      std::vector<float> found(64 * 64), slopes(found.size(), NAN);
      objective.write_slopes(pair.hypothesis(), 0, found, slopes);
      EXPECT_EQ(found, expected);
      int compared = 0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (slopes[i] == 0 || near[i] == unseen || far[i] == unseen) continue;
        EXPECT_NEAR(slopes[i] * step, near[i] - far[i], 1e-3) << i;
        ++compared;
      }
      EXPECT_GT(compared, 500);
    });
  }
}

TEST(PatchResiduals, HaveNoSlopesWhereNothingIsSeenTwice) {
  const PatchPair pair({.size = 32}, true);
  StereoPatch objective({});
  objective.prepare(pair.observation);
  DepthTile tiles[2] = {pair.tiles[0], pair.tiles[1]};
  const std::vector<float> empty(pair.depth[1].size(), 0.0f);
  tiles[1].inverse_depth = empty.data();
  std::vector<float> found(32 * 32), slopes(found.size(), NAN);
  objective.write_slopes({{}, tiles}, 0, found, slopes);
  EXPECT_EQ(found, test::written_residuals(objective, {{}, tiles}));
  EXPECT_EQ(slopes, std::vector<float>(slopes.size(), 0.0f));
}

}  // namespace
}  // namespace hypotrack::stereo_patch
