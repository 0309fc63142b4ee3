#include "residuals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "../support/every_target.hpp"
#include "patch_pair.hpp"
#include "score.hpp"
#include "stereo_patch.hpp"
#include "volume_kernel.hpp"
#include "written_residuals.hpp"

namespace hypotrack::stereo_patch {
namespace {

/// On every instruction set that all three kernels are compiled for.
template <class Body>
void on_every_target(Body body) {
  test::on_every_target(score_targets() & volume_targets(), body);
}

void expect_cost_as_squares(const PatchPair& pair, const Params& params) {
  on_every_target([&] {
    StereoPatch objective(params);
    objective.prepare(pair.observation);
    ASSERT_EQ(objective.residual_term(), &objective);
    const double cost = objective.cost(pair.hypothesis());
    ASSERT_LT(cost, 0);
    const TileView& view = pair.observation.views[0];
    const double counting =
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

}  // namespace
}  // namespace hypotrack::stereo_patch
