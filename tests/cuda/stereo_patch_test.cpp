// The volume and the costs of stereo_patch on the GPU against those of the CPU.
#include "stereo_patch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "cuda/device_volume.hpp"
#include "device.hpp"
#include "device_scores.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "made_up_frame.hpp"
#include "observations.hpp"
#include "patch_pair.hpp"
#include "settings.hpp"
#include "volume.hpp"

namespace hypotrack::stereo_patch {
namespace {

/// Two volumes beside each other.
struct Comparison {
  std::size_t numbers = 0;
  std::size_t apart = 0;  ///< numbers more than `rounding` apart
  double sum = 0;         ///< of the expected similarities
};

Comparison compare(DeviceVolume& volume, const Observation& observation, const Settings& settings,
                   int rounding) {
  Volume expected;
  make_volume(observation, settings, expected);
  const test::DeviceFrame frame(observation, {});
  volume.enqueue(frame.observation(), {});
  const Planes planes = test::download(volume.planes(), 1, {})[0];
  EXPECT_EQ(planes.count, expected.planes.count);
  EXPECT_EQ(planes.first, expected.planes.first);
  EXPECT_EQ(planes.step, expected.planes.step);
  const auto size = expected.row_stride() * static_cast<std::size_t>(expected.height);
  const std::vector<std::uint32_t> words = test::download(volume.words(), size, {});
  Comparison out;
  for (std::size_t i = 0; i < size; ++i) {
    for (const int shift : {0, 16}) {
      const int there = static_cast<int>(words[i] >> shift & 0xFFFF);
      const int here = static_cast<int>(expected.words[i] >> shift & 0xFFFF);
      out.apart += std::abs(there - here) > rounding;
      out.sum += here / 65535.0;
      ++out.numbers;
    }
  }
  return out;
}

class StereoPatchOnDevice : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }
};

TEST_F(StereoPatchOnDevice, FillsTheVolumeAsTheCpu) {
  DeviceVolume volume({});
  for (const bool rectified : {true, false}) {
    for (const int size : {128, 61, 33}) {
      SCOPED_TRACE(testing::Message() << rectified << " " << size);
      const PatchPair pair({.rectified = rectified, .size = size}, true);
      const Comparison c = compare(volume, pair.observation, {}, 8);
      EXPECT_GT(c.sum, 0.01 * static_cast<double>(c.numbers));
      EXPECT_EQ(c.apart, 0u);
    }
  }
}

TEST_F(StereoPatchOnDevice, FillsTheVolumeAsTheCpuWithOtherParameters) {
  Settings settings;
  settings.radius = 15;
  settings.sharpness = 1;
  settings.variance_floor = 1e-3;
  settings.step = 1;
  for (const bool use_mask : {true, false}) {
    settings.use_mask = use_mask;
    DeviceVolume volume(settings);
    const PatchPair pair({.mask = true, .size = 96}, true);
    const Comparison c = compare(volume, pair.observation, settings, 8);
    EXPECT_GT(c.sum, 0.01 * static_cast<double>(c.numbers));
    EXPECT_EQ(c.apart, 0u);
  }
}

TEST_F(StereoPatchOnDevice, FillsTheVolumeAsTheCpuByCensus) {
  Settings settings;
  settings.measure = Measure::census;
  DeviceVolume volume(settings);
  for (const bool rectified : {true, false}) {
    // A neighbour that is as bright as the middle is darker or not as rounding has it.
    const PatchPair pair({.rectified = rectified}, true);
    const Comparison c = compare(volume, pair.observation, settings, 8);
    EXPECT_GT(c.sum, 0.01 * static_cast<double>(c.numbers));
    EXPECT_LT(static_cast<double>(c.apart), 0.01 * static_cast<double>(c.numbers));
  }
}

TEST_F(StereoPatchOnDevice, ItsMemoryStaysWhereItIs) {
  DeviceVolume volume({});
  const PatchPair large({.size = 128}), small({.size = 61});
  compare(volume, large.observation, {}, 8);
  const auto* words = volume.words();
  const auto* planes = volume.planes();
  compare(volume, small.observation, {}, 8);
  EXPECT_EQ(volume.words(), words);
  EXPECT_EQ(volume.planes(), planes);
}

TEST_F(StereoPatchOnDevice, ScoresAsTheCpu) {
  const Scene hand = test::hand_scene(), both = test::hand_and_box_scene();
  for (const auto measure : {Measure::zncc, Measure::census}) {
    Params params;
    params.measure = measure;
    params.sharpness = 1;  // the made-up views are not that alike
    const auto make = [params] { return std::make_shared<StereoPatch>(params); };
    test::expect_like_the_cpu(hand, test::colored(test::rectified_pair(hand, 256)), make);
    test::expect_like_the_cpu(both, test::colored(test::rectified_pair(both, 512)), make);
    test::expect_like_the_cpu(both, test::colored(test::general_pair(both, 256)), make);
  }
}

TEST_F(StereoPatchOnDevice, ScoresAsTheCpuWherePixelsCountForAPartOnly) {
  const Scene hand = test::hand_scene();
  Observation frame = test::colored(test::rectified_pair(hand, 256));
  frame.context.color_difference = 0.01;
  Params params;
  params.sharpness = 1;
  params.full_at_difference = 0.02;
  test::expect_like_the_cpu(hand, frame,
                            [params] { return std::make_shared<StereoPatch>(params); });
}

TEST_F(StereoPatchOnDevice, CostsNothingWhereNothingIsSeen) {
  const Scene scene = test::hand_scene();
  Eigen::MatrixXd states = test::scored_states(scene).leftCols(2);
  Observation observation = test::colored(test::rectified_pair(scene));
  observation.start = states.col(0);
  states(2, 0) = -0.5;  // behind the cameras
  states(0, 1) = 30;    // beside the tiles
  const auto make = [] { return std::make_shared<StereoPatch>(Params{}); };
  EXPECT_EQ(test::costs_on(Backend::cuda, scene, observation, make, states),
            Eigen::Vector2d::Zero());
}

TEST(StereoPatchWithoutDevice, RefusesWhatTheCpuRefusesInItsWords) {
  PatchPair pair({.size = 32});
  pair.observation.views.pop_back();
  StereoPatch objective({});
  cuda::DeviceObservation frame;
  frame.header = &pair.observation;
  frame.tiles[0].has_color = true;
  DeviceVolume volume({});
  EXPECT_EQ(test::message_of<DataError>([&] { volume.enqueue(frame, {}); }),
            test::message_of<DataError>([&] { objective.prepare(pair.observation); }));
}

TEST(StereoPatchWithoutDevice, HasADevicePart) { EXPECT_TRUE(make_device_objective({})); }

}  // namespace
}  // namespace hypotrack::stereo_patch
