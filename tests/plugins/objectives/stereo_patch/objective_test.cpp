#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "patch_pair.hpp"
#include "stereo_patch.hpp"

namespace hypotrack::stereo_patch {
namespace {

using test::message_of;
using testing::HasSubstr;

TEST(StereoPatch, OneViewIsAnErrorThatSaysWhatIsExpected) {
  PatchPair pair({.size = 32});
  pair.observation.views.pop_back();
  StereoPatch objective({});
  const std::string message = message_of<DataError>([&] { objective.prepare(pair.observation); });
  EXPECT_THAT(message, HasSubstr("objective stereo_patch"));
  EXPECT_THAT(message, HasSubstr("expected two calibrated views"));
}

TEST(StereoPatch, TilesOfAnotherSizeThanThePreparedFrameAreErrors) {
  const PatchPair pair({.size = 32}), other({.size = 48});
  StereoPatch objective({});
  objective.prepare(pair.observation);
  EXPECT_THAT(message_of<DataError>([&] { objective.cost(other.hypothesis()); }),
              HasSubstr("objective stereo_patch"));
  EXPECT_THAT(message_of<DataError>([&] { objective.cost({}); }),
              HasSubstr("expected a 32x32 tile"));
}

TEST(StereoPatch, NothingCoveredCostsNothing) {
  PatchPair pair({.size = 32});
  StereoPatch objective({});
  objective.prepare(pair.observation);
  for (DepthTile& tile : pair.tiles) tile.x0 = tile.y0 = tile.x1 = tile.y1 = 0;
  const double cost = objective.cost(pair.hypothesis());
  EXPECT_EQ(cost, 0);
  EXPECT_FALSE(std::signbit(cost));
}

TEST(StereoPatch, CountsTheLessTheBetterTheViewsAgreeOnColours) {
  PatchPair pair({.size = 64}, true);
  Params params;
  const auto cost = [&](double difference) {
    pair.observation.context.color_difference = difference;
    StereoPatch objective(params);
    objective.prepare(pair.observation);
    return objective.cost(pair.hypothesis());
  };
  const double full = cost(0.001);
  ASSERT_LT(full, 0);
  params.full_at_difference = 0.02;
  EXPECT_EQ(cost(0), full);  // not known
  EXPECT_EQ(cost(0.02), full);
  EXPECT_EQ(cost(0.1), full);
  EXPECT_NEAR(cost(0.01) / full, 0.25, 0.25 * 0.05);  // up to half a step of a tenth
  EXPECT_NEAR(cost(0.002) / full, 0.01, 0.01 * 0.05);
}

/// Cost of a plane at a depth that fills both tiles of a pair that looks at one at 0.5 m.
double cost_of_plane(const StereoPatch& objective, double depth) {
  std::vector<float> tile(128 * 128, static_cast<float>(1 / depth));
  const DepthTile both[] = {{128, 128, 128, tile.data(), 0, 0, 128, 128},
                            {128, 128, 128, tile.data(), 0, 0, 128, 128}};
  return objective.cost({{}, both});
}

TEST(StereoPatch, PrefersTheDepthOfWhatIsSeen) {
  const PatchPair pair({}, true);
  for (const auto measure : {Measure::zncc, Measure::census}) {
    Params params;
    params.measure = measure;
    StereoPatch objective(params);
    objective.prepare(pair.observation);
    const double right = cost_of_plane(objective, 0.5);
    for (const double depth : {0.47, 0.485, 0.495, 0.505, 0.515, 0.53}) {
      EXPECT_GT(cost_of_plane(objective, depth), 0.9 * right) << depth;
    }
  }
}

}  // namespace
}  // namespace hypotrack::stereo_patch
