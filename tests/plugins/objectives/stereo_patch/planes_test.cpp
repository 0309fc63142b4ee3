#include <gtest/gtest.h>

#include "patch_pair.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {
namespace {

TEST(Planes, LieAStepApartAroundTheLastSolution) {
  const PatchPair pair({});
  const Settings settings;
  const Planes planes = planes_around(pair.observation, settings);
  // The box's faces are 10 mm from its middle at 0.5 m.
  EXPECT_NEAR(1 / double{planes.first}, 0.5 + 0.010 + settings.range, 1e-6);
  const double last = double{planes.first} + (planes.count - 1) * double{planes.step};
  EXPECT_NEAR(1 / last, 0.5 - 0.010 - settings.range, 1e-5);
  const double pixels_per_unit = 5.5 * 128 * 0.1;  // focal length times baseline
  EXPECT_LE(planes.step * pixels_per_unit, settings.step * 1.0001);
  EXPECT_GT(planes.step * pixels_per_unit, settings.step * 0.9);
}

TEST(Planes, OfAGeneralPairLieNoFartherApart) {
  const PatchPair pair({.rectified = false});
  const Planes planes = planes_around(pair.observation, {});
  // Along the middle's epipolar line: the pixel moves by about focal * baseline / z.
  EXPECT_LE(planes.step * 5.5 * 128 * 0.07, Settings().step);
  EXPECT_GT(planes.count, 20);
}

TEST(Planes, OfViewsFarApartLieFartherApart) {
  const PatchPair pair({});
  Settings settings;
  settings.step = 1;
  const int usual = planes_around(pair.observation, settings).count;
  settings.range = 0.3;
  const int many = planes_around(pair.observation, settings).count;
  settings.range = 0.4;
  EXPECT_GT(many, usual);
  EXPECT_EQ(planes_around(pair.observation, settings).count, many);
}

TEST(Planes, AreNoMoreThanMemoryAllows) {
  const PatchPair pair({});
  Settings settings;
  settings.step = 0.1;
  settings.range = 0.4;
  EXPECT_EQ(planes_around(pair.observation, settings).count, kMostPlanes);
  PatchPair large({});
  for (TileView& view : large.observation.views) view.camera.width = view.camera.height = 1024;
  EXPECT_EQ(planes_around(large.observation, settings).count, kMostNumbers / (1024 * 1024));
}

TEST(Planes, StayInFrontOfTheCameraWhateverTheRange) {
  PatchPair pair({});
  Settings settings;
  settings.range = 10;
  const Planes planes = planes_around(pair.observation, settings);
  EXPECT_GT(planes.first, 0);
  EXPECT_GT(planes.step, 0);
  pair.observation.start[2] = -20;
  const Planes behind = planes_around(pair.observation, settings);
  EXPECT_GT(behind.first, 0);
  EXPECT_GT(behind.step, 0);
}

}  // namespace
}  // namespace hypotrack::stereo_patch
