#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "every_target.hpp"
#include "random_pair.hpp"
#include "stereo_color.hpp"

namespace hypotrack::stereo_color {
namespace {

/// Returns the sum of the numbers of the maps of a name, and how many there are.
std::pair<double, int> sum_of(const std::vector<PixelMap>& maps, const std::string& name) {
  double sum = 0;
  int count = 0;
  for (const PixelMap& map : maps) {
    if (map.name != name) continue;
    for (const float value : cv::Mat1f(map.values)) {
      if (std::isnan(value)) continue;
      sum += value;
      ++count;
    }
  }
  return {sum, count};
}

TEST(Maps, ConsistencyAddsUpToTheCost) {
  for (const auto direction :
       {Direction::left_to_right, Direction::right_to_left, Direction::both}) {
    for (const auto lookup : {Lookup::nearest, Lookup::bilinear}) {
      const RandomPair pair({.mask = true, .size = 96});
      Params params;
      params.beta = 20;
      params.direction = direction;
      params.lookup = lookup;
      StereoColor objective(params);
      objective.prepare(pair.observation);
      on_every_target([&] {
        const double share = direction == Direction::both ? 0.5 : 1;
        const auto [sum, count] = sum_of(objective.maps(pair.hypothesis()), "consistency");
        EXPECT_NEAR(-share * sum / objective.cost(pair.hypothesis()), 1, 1e-4);
        EXPECT_GT(count, 100);
      });
    }
  }
}

TEST(Maps, ConsistencyFollowsFromDistinctivenessAndColourDifference) {
  const RandomPair pair({.mask = false, .size = 96});
  Params params;
  params.beta = 20;
  params.distinctiveness = Distinctiveness::none;
  StereoColor objective(params);
  objective.prepare(pair.observation);
  const std::vector<PixelMap> maps = objective.maps(pair.hypothesis());
  ASSERT_EQ(maps.size(), 2u);  // and no map of distinctiveness
  const cv::Mat1f differences = maps[0].values, consistencies = maps[1].values;
  int known = 0;
  for (int y = 0; y < differences.rows; ++y) {
    for (int x = 0; x < differences.cols; ++x) {
      const float difference = differences(y, x), consistency = consistencies(y, x);
      ASSERT_EQ(std::isnan(difference), std::isnan(consistency));
      if (std::isnan(difference) || consistency == 0) continue;  // 0: outside an image
      EXPECT_NEAR(consistency, std::exp(-20 * difference), 1e-3);
      ++known;
    }
  }
  EXPECT_GT(known, 100);
}

}  // namespace
}  // namespace hypotrack::stereo_color
