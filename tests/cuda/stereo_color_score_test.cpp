#include <gtest/gtest.h>

#include "device.hpp"
#include "device_scores.hpp"
#include "observations.hpp"
#include "stereo_color.hpp"

namespace hypotrack::stereo_color {
namespace {

test::MakeObjective stereo_color(const Params& params) {
  return [params] { return std::make_shared<StereoColor>(params); };
}

class StereoColorOnDevice : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }

  // One pixel whose lookup rounds to its neighbour may differ by all it can score. Large tiles, and
  // colours and a mask that say about the same there, keep that small beside the score.
  static void expect_like_the_cpu_everywhere(Params params) {
    params.beta = 2;  // the made-up views are not that alike
    const Scene hand = test::hand_scene(), both = test::hand_and_box_scene();
    const auto make = stereo_color(params);
    test::expect_like_the_cpu(hand, test::colored(test::rectified_pair(hand, 256)), make);
    test::expect_like_the_cpu(both, test::colored(test::rectified_pair(both, 512)), make);
    test::expect_like_the_cpu(both, test::colored(test::general_pair(both, 256)), make);
  }
};

TEST_F(StereoColorOnDevice, ScoresAsTheCpuByDefault) { expect_like_the_cpu_everywhere({}); }

TEST_F(StereoColorOnDevice, ScoresAsTheCpuInEveryDirectionAndLookup) {
  for (const auto direction :
       {Direction::left_to_right, Direction::right_to_left, Direction::both}) {
    for (const auto lookup : {Lookup::nearest, Lookup::bilinear}) {
      Params params;
      params.direction = direction;
      params.lookup = lookup;
      expect_like_the_cpu_everywhere(params);
    }
  }
}

TEST_F(StereoColorOnDevice, ScoresAsTheCpuInEveryAggregation) {
  for (const auto aggregation : {Aggregation::sum, Aggregation::mean_seen,
                                 Aggregation::mean_rendered, Aggregation::sum_per_sqrt}) {
    for (const auto direction : {Direction::right_to_left, Direction::both}) {
      Params params;
      params.aggregation = aggregation;
      params.direction = direction;
      expect_like_the_cpu_everywhere(params);
    }
  }
}

TEST_F(StereoColorOnDevice, ScoresAsTheCpuWithEveryFalloffAndCoveragePenalty) {
  for (const auto falloff : {Falloff::exponential, Falloff::gaussian}) {
    for (const auto lookup : {Lookup::nearest, Lookup::bilinear}) {
      Params params;
      params.falloff = falloff;
      params.coverage_penalty = 0.1;
      params.lookup = lookup;
      expect_like_the_cpu_everywhere(params);
    }
  }
}

TEST_F(StereoColorOnDevice, ScoresAsTheCpuWithABetaThatFollowsThePictures) {
  const Scene hand = test::hand_scene();
  Observation frame = test::colored(test::rectified_pair(hand, 256));
  Params params;
  params.beta_by_difference = 0.8;
  params.beta_min = 1;
  for (const double difference : {0.0, 0.2, 0.4}) {
    frame.context.color_difference = difference;
    test::expect_like_the_cpu(hand, frame, stereo_color(params));
  }
}

TEST_F(StereoColorOnDevice, ScoresAsTheCpuInEveryColorSpace) {
  for (const auto space : {ColorSpace::lab, ColorSpace::hsv, ColorSpace::gray}) {
    Params params;
    params.color_space = space;
    expect_like_the_cpu_everywhere(params);
  }
}

TEST_F(StereoColorOnDevice, CostsNothingWhereNothingIsSeen) {
  const Scene scene = test::hand_scene();
  Eigen::MatrixXd states = test::scored_states(scene).leftCols(2);
  states(2, 0) = -0.5;  // behind the cameras
  states(0, 1) = 30;    // beside the tiles
  for (const auto aggregation : {Aggregation::sum, Aggregation::mean_seen,
                                 Aggregation::mean_rendered, Aggregation::sum_per_sqrt}) {
    Params params;
    params.aggregation = aggregation;
    const Eigen::VectorXd costs =
        test::costs_on(Backend::cuda, scene, test::colored(test::rectified_pair(scene)),
                       stereo_color(params), states);
    EXPECT_EQ(costs, Eigen::Vector2d::Zero());
  }
}

}  // namespace
}  // namespace hypotrack::stereo_color
