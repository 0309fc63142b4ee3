#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <opencv2/core.hpp>

#include "colored_box.hpp"
#include "every_target.hpp"
#include "hypotrack/plugin/pixel.hpp"
#include "score.hpp"
#include "skin.hpp"

namespace hypotrack::skin {
namespace {

double cost(Skin& objective, const Observation& observation, const cv::Rect& covered) {
  objective.prepare(observation);
  return objective.cost(Rectangle(observation, covered).hypothesis());
}

double cost(const Params& params, const Observation& observation, const cv::Rect& covered) {
  Skin objective(params);
  return cost(objective, observation, covered);
}

Observation masked(const cv::Rect& foreground) {
  Observation out = colored_box();
  for (TileView& view : out.views) {
    view.mask = cv::Mat1b(view.color.rows, view.color.cols, uchar{0});
    view.mask(foreground).setTo(255);
  }
  return out;
}

TEST(SkinCost, CountsUncoveredForegroundAndCoveredBackground) {
  const Observation observation = masked({10, 10, 20, 30});
  Params params;
  params.spill = 0.5;
  EXPECT_NEAR(cost(params, observation, {10, 10, 20, 30}), 0, 1e-3);
  EXPECT_NEAR(cost(params, observation, {0, 0, 0, 0}), 600, 1e-2);
  EXPECT_NEAR(cost(params, observation, {20, 10, 20, 30}), 300 + 0.5 * 300, 1e-2);
}

TEST(SkinCost, IsTheMeanOfTheViews) {
  Observation observation = masked({10, 10, 20, 30});
  observation.views[1].mask.setTo(0);
  EXPECT_NEAR(cost({}, observation, {10, 10, 20, 30}), 300, 1e-2);
}

TEST(SkinCost, ByDepthHasTheForegroundAroundTheLastSolution) {
  Observation observation = colored_box();
  for (TileView& view : observation.views) {
    view.depth = cv::Mat1f(view.color.rows, view.color.cols, 0.9f);
    view.depth(cv::Rect(5, 5, 10, 10)).setTo(0.5);
    view.depth(cv::Rect(40, 5, 10, 10)).setTo(0);
  }
  Params params;
  params.foreground = Foreground::depth;
  EXPECT_NEAR(cost(params, observation, {0, 0, 0, 0}), 100, 1e-2);
  EXPECT_NEAR(cost(params, observation, {5, 5, 10, 10}), 0, 1e-2);
}

TEST(SkinCost, LeavesOutPixelsThatNobodySaw) {
  Observation observation = masked({0, 0, 96, 96});
  for (TileView& view : observation.views) view.valid.rowRange(10, 96).setTo(0);
  EXPECT_NEAR(cost({}, observation, {0, 0, 0, 0}), 960, 1e-2);
  EXPECT_NEAR(cost({}, observation, {0, 0, 96, 10}), 0, 1e-2);
  EXPECT_NEAR(cost({}, observation, {0, 0, 96, 96}), 0, 1e-2);
}

TEST(SkinCost, IsLeastWhereTheLearnedColoursAre) {
  const Observation observation = colored_box();
  Skin objective({});
  const cv::Rect box = box_outline();
  const double right = cost(objective, observation, box);
  EXPECT_LT(right, 0.15 * box.area());
  for (const cv::Point& by : {cv::Point(6, 0), cv::Point(-6, 0), cv::Point(0, 6)}) {
    EXPECT_GT(cost(objective, observation, box + by), right + 0.15 * box.area());
  }
  EXPECT_GT(cost(objective, observation, {0, 0, 0, 0}), 0.8 * box.area());
}

TEST(SkinCost, IsThatOfEveryInstructionSet) {
  cv::RNG random(3);
  PixelPlane<std::uint32_t> plane(37, 20);
  std::vector<float> depth(37 * 20);
  double expected = 0;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 37; ++x) {
      const float p = random.uniform(0.0f, 1.0f);
      plane.row(y)[x] = pack_unorm16(p, 1 - p);
      const bool covered = random.uniform(0, 2) > 0;
      depth[static_cast<std::size_t>(y) * 37 + x] = covered ? 2.0f : 0.0f;
      if (covered) expected += 0.7 * (1 - p) - p;
    }
  }
  const DepthTile tile{37, 20, 37, depth.data(), 0, 0, 37, 20};
  test::on_every_target(compiled_targets(),
                        [&] { EXPECT_NEAR(sum_covered(plane, tile, 0.7f), expected, 0.02); });
}

}  // namespace
}  // namespace hypotrack::skin
