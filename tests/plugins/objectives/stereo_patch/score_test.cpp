#include "score.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "every_kernel_target.hpp"
#include "patch_pair.hpp"
#include "reference.hpp"
#include "stereo_patch.hpp"
#include "volume_kernel.hpp"

namespace hypotrack::stereo_patch {
namespace {

double fast(const PatchPair& pair, const Params& params) {
  StereoPatch objective(params);
  objective.prepare(pair.observation);
  return objective.cost(pair.hypothesis());
}

void expect_like_reference(const PatchPair& pair, const Params& params, double tolerance = 1e-3) {
  const double expected = reference::cost(pair.observation, pair.hypothesis(), params);
  ASSERT_LT(expected, 0);
  on_every_target([&] { EXPECT_NEAR(fast(pair, params) / expected, 1, tolerance); });
}

TEST(PatchScore, IsTheReferencesForRectifiedPairs) {
  expect_like_reference(PatchPair({.size = 48}), {});
  expect_like_reference(PatchPair({.size = 48}, true), {});
}

TEST(PatchScore, IsTheReferencesForGeneralPairs) {
  expect_like_reference(PatchPair({.rectified = false, .size = 48}), {});
  expect_like_reference(PatchPair({.rectified = false, .size = 48}, true), {});
}

TEST(PatchScore, IsTheReferencesForOtherParameters) {
  Params params;
  params.radius = 2;
  params.sharpness = 2;
  params.variance_floor = 1e-3;
  params.step = 1;
  params.r = 1.5 * kMillimetre;
  expect_like_reference(PatchPair({.mask = true, .size = 48, .seed = 3}, true), params);
  params.use_mask = false;
  expect_like_reference(PatchPair({.mask = true, .size = 48, .seed = 3}, true), params);
}

TEST(PatchScore, IsTheReferencesByCensus) {
  Params params;
  params.measure = Measure::census;
  params.radius = 2;
  // A neighbour that is as bright as the middle is darker or not as rounding has it.
  expect_like_reference(PatchPair({.size = 40}, true), params, 5e-3);
  expect_like_reference(PatchPair({.rectified = false, .size = 40}, true), params, 5e-3);
}

TEST(PatchScore, IsTheReferencesForOddSizesAndStrides) {
  for (const int size : {17, 31, 33}) {
    for (const bool rectified : {true, false}) {
      SCOPED_TRACE(testing::Message() << size << " " << rectified);
      expect_like_reference(
          PatchPair({.rectified = rectified, .size = size, .stride_beyond = 3}, true), {});
    }
  }
}

TEST(PatchScore, DoesNotChangeWithBrightnessAndContrastOfAView) {
  PatchPair pair({}, true);
  const double before = fast(pair, {});
  change_brightness(pair.observation.views[1], 0.8, 20);
  EXPECT_NEAR(fast(pair, {}) / before, 1, 0.01);
}

TEST(PatchScore, OfUniformSurfacesIsNextToNothing) {
  PatchPair pair({}, true);
  for (TileView& view : pair.observation.views) view.color.setTo(cv::Scalar(20, 20, 20));
  int covered = 0;
  for (const float w : pair.depth[0]) covered += w > 0;
  EXPECT_GT(fast(pair, {}), -1.01 * std::exp(-5) * covered) << "no correlation: z = 0";
}

TEST(PatchScore, OfDepthsThatAreNotComparedIsNothing) {
  PatchPair pair({}, true);
  Params params;
  params.range = 1e-3;
  pair.observation.start[2] = 0.8;  // the hypothesis lies about 0.5 m
  EXPECT_EQ(fast(pair, params), 0);
}

TEST(PatchScore, OfPatchesThatReachOntoInvalidPixelsIsNothing) {
  PatchPair pair({}, true);
  pair.observation.views[1].valid.setTo(0);
  EXPECT_EQ(fast(pair, {}), 0);
}

TEST(PatchScore, IsBitIdenticalForEqualInputs) {
  EXPECT_EQ(fast(PatchPair({.mask = true}), {}), fast(PatchPair({.mask = true}), {}));
}

TEST(PatchScore, OfAFrameDoesNotDependOnTheFrameBefore) {
  const PatchPair large({.size = 64, .seed = 2}, true), small({.size = 32, .seed = 3}, true);
  StereoPatch objective({});
  objective.prepare(large.observation);
  objective.prepare(small.observation);
  EXPECT_EQ(objective.cost(small.hypothesis()), fast(small, {}));
  objective.prepare(large.observation);
  EXPECT_EQ(objective.cost(large.hypothesis()), fast(large, {}));
}

}  // namespace
}  // namespace hypotrack::stereo_patch
