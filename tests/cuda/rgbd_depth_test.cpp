// What rgbd_depth observes on the GPU against what it observes on the CPU.
#include "rgbd_depth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "../support/device.hpp"
#include "cuda/device_frame.hpp"
#include "depth_scene.hpp"
#include "device_scores.hpp"
#include "expect_error.hpp"
#include "foreground.hpp"
#include "hypotrack/api/error.hpp"
#include "made_up_frame.hpp"
#include "observations.hpp"
#include "params.hpp"
#include "settings.hpp"

namespace hypotrack::rgbd_depth {
namespace {

constexpr Foreground kAll[] = {Foreground::automatic, Foreground::mask, Foreground::depth,
                               Foreground::skin};

/// A view of the box with depth before, within, behind and on the edges of its range, holes,
/// numbers that are none, colours of all kinds, a mask and pixels outside of the image.
TileView noisy_view(int size, unsigned seed) {
  TileView view = blank_view(size);
  view.camera.height = size - 3;
  std::mt19937 random(seed);
  const auto image = [&](auto pixel) {
    cv::Mat_<decltype(pixel())> out(size - 3, size);
    for (auto& value : out) value = pixel();
    return out;
  };
  const auto one_of = [&](unsigned n) { return random() % n; };
  const float special[] = {0.0f, -1.0f, std::nanf(""), 0.34f, 0.66f, INFINITY};
  view.depth = image([&] {
    return one_of(3) == 0 ? special[one_of(6)] : 0.2f + 0.001f * static_cast<float>(one_of(600));
  });
  view.color = image([&] {
    return one_of(2) == 0
               ? cv::Vec3b(105, 172, 224)
               : cv::Vec3b(cv::Vec3i(static_cast<int>(one_of(256)), static_cast<int>(one_of(256)),
                                     static_cast<int>(one_of(256))));
  });
  view.valid = image([&] { return static_cast<uchar>(one_of(5) == 0 ? 0 : 255); });
  view.mask = image([&] { return static_cast<uchar>(one_of(2) == 0 ? 0 : 1); });
  return view;
}

void expect_what_the_cpu_observes(DeviceFrame& frame, const Observation& observation,
                                  const Settings& settings) {
  const test::DeviceFrame uploaded(observation, {});
  frame.enqueue(uploaded.observation(), {});
  std::int64_t foreground = 0, measured = 0;
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    SCOPED_TRACE("view " + std::to_string(i));
    const TileView& view = observation.views[i];
    const float* found = frame.observed(static_cast<int>(i));
    ASSERT_EQ(found == nullptr, view.depth.empty());
    if (!found) continue;
    const DepthRange range =
        depth_range(*observation.scene, observation.start, view.camera, settings.range);
    const ObservedView expected = observe(view, settings.foreground, range);
    foreground += expected.foreground;
    measured += expected.measured;
    const std::vector<float> plane = test::download(found, view.depth.total(), {});
    EXPECT_TRUE(std::equal(plane.begin(), plane.end(), expected.pixels.row(0)));
  }
  EXPECT_GT(measured, 0);
  EXPECT_GT(foreground, measured - 1);
  const Counts counts = test::download(frame.counts(), 1, {})[0];
  EXPECT_EQ(counts.foreground, foreground);
  EXPECT_EQ(counts.measured, measured);
}

TEST(RgbdDepthOnDevice, ObservesWhatTheCpuObservesByEveryForeground) {
  SKIP_WITHOUT_DEVICE();
  for (const Foreground foreground : kAll) {
    SCOPED_TRACE(enum_names(foreground)[static_cast<std::size_t>(foreground)]);
    Settings settings;
    settings.foreground = foreground;
    DeviceFrame frame(settings);
    for (const int size : {128, 61, 300}) {
      Observation observation = blank_observation(4);
      observation.views = {noisy_view(size, 1), noisy_view(size, 2), noisy_view(size, 3)};
      observation.views[1].depth.release();
      expect_what_the_cpu_observes(frame, observation, settings);
      if (foreground == Foreground::mask) continue;
      observation.views[2].mask.release();
      expect_what_the_cpu_observes(frame, observation, settings);
    }
  }
}

TEST(RgbdDepthOnDevice, ItsMemoryStaysWhereItIs) {
  SKIP_WITHOUT_DEVICE();
  DeviceFrame frame({});
  Observation observation = blank_observation(4);
  observation.views = {noisy_view(128, 1)};
  const test::DeviceFrame large(observation, {});
  frame.enqueue(large.observation(), {});
  const float* plane = frame.observed(0);
  const Counts* counts = frame.counts();
  observation.views = {noisy_view(61, 2)};
  const test::DeviceFrame small(observation, {});
  frame.enqueue(small.observation(), {});
  EXPECT_EQ(frame.observed(0), plane);
  EXPECT_EQ(frame.counts(), counts);
}

// Every colour there is, as skin that was not measured.
TEST(RgbdDepthOnDevice, TellsSkinLikeTheCpuForEveryColour) {
  SKIP_WITHOUT_DEVICE();
  constexpr int kSide = 4096;
  Settings settings;
  settings.foreground = Foreground::skin;
  DeviceFrame frame(settings);
  Observation observation = blank_observation(4);
  TileView& view = observation.views[0];
  view.camera.width = view.camera.height = kSide;
  view.depth = cv::Mat1f(kSide, kSide, 0.0f);
  view.depth.at<float>(0, 0) = 0.5f;
  view.valid = cv::Mat1b(kSide, kSide, uchar{255});
  view.color = cv::Mat3b(kSide, kSide);
  for (int i = 0; i < kSide * kSide; ++i) {
    view.color.at<cv::Vec3b>(i / kSide, i % kSide) =
        cv::Vec3b(static_cast<uchar>(i), static_cast<uchar>(i >> 8), static_cast<uchar>(i >> 16));
  }
  view.color.at<cv::Vec3b>(0, 0) = cv::Vec3b(105, 172, 224);
  expect_what_the_cpu_observes(frame, observation, settings);
}

TEST(RgbdDepthOnDevice, ScoresAndHasTheResidualsOfTheCpu) {
  SKIP_WITHOUT_DEVICE();
  const auto make = [] { return std::make_shared<RgbdDepth>(Params{}); };
  const Scene hand = test::hand_scene(), both = test::hand_and_box_scene();
  test::expect_like_the_cpu(hand, test::with_depth(test::colored(test::rectified_pair(hand, 256))),
                            make);
  test::expect_like_the_cpu(both, test::with_depth(test::colored(test::general_pair(both, 256))),
                            make);
  Observation one = test::with_depth(test::colored(test::general_pair(both, 256)));
  one.views[0].depth.release();
  test::expect_like_the_cpu(both, one, make);
}

std::string refusal_on_cpu(const Observation& observation, Foreground foreground) {
  return test::message_of<DataError>([&] { check(observation, foreground); });
}

/// Needs no device: what is on it is told by flags.
std::string refusal_on_device(const Observation& observation, Foreground foreground) {
  static const float kDepth = 0;
  cuda::DeviceObservation frame;
  frame.header = &observation;
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& view = observation.views[i];
    frame.tiles[i].layout.depth = view.depth.empty() ? nullptr : &kDepth;
    frame.tiles[i].has_mask = !view.mask.empty();
    frame.tiles[i].has_color = !view.color.empty();
  }
  return test::message_of<DataError>([&] { check(frame, foreground); });
}

TEST(RgbdDepthOnDevice, RefusesWhatTheCpuRefusesInItsWords) {
  Observation none = blank_observation(4);
  none.views[0].depth.release();
  Observation bare = blank_observation(4);
  bare.views.push_back(bare.views[0]);
  EXPECT_EQ(refusal_on_device(none, Foreground::automatic),
            refusal_on_cpu(none, Foreground::automatic));
  for (const Foreground foreground : {Foreground::mask, Foreground::skin}) {
    EXPECT_EQ(refusal_on_device(bare, foreground), refusal_on_cpu(bare, foreground));
  }
}

TEST(RgbdDepthOnDevice, IsThereWithoutADevice) { EXPECT_TRUE(make_device_objective({})); }

}  // namespace
}  // namespace hypotrack::rgbd_depth
