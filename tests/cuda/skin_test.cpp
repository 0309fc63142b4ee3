// What skin sees and costs on the GPU against what it does on the CPU.
#include "skin.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "colored_box.hpp"
#include "cuda/device_foreground.hpp"
#include "device.hpp"
#include "device_scores.hpp"
#include "expect_error.hpp"
#include "foreground.hpp"
#include "hypotrack/api/error.hpp"
#include "made_up_frame.hpp"
#include "observations.hpp"
#include "rule.hpp"
#include "settings.hpp"

namespace hypotrack::skin {
namespace {

/// The box in three views, of which the second has nothing to look at; with holes, a mask and depth
/// before, within and behind its range.
Observation box_in_views(int frame) {
  Observation out = colored_box();
  out.frame = frame;
  out.views.push_back(out.views[0]);
  for (TileView& view : out.views) {
    view.valid = view.valid.clone();
    view.valid.colRange(0, 20).setTo(0);
    view.mask = cv::Mat1b(view.color.rows, view.color.cols, uchar{0});
    view.mask(cv::Rect(10, 10, 40, 30)).setTo(255);
    view.depth = cv::Mat1f(view.color.rows, view.color.cols, 0.9f);
    view.depth(cv::Rect(30, 5, 20, 30)).setTo(0.5);
    view.depth(cv::Rect(40, 5, 20, 10)).setTo(0);
  }
  out.views[1].color.release();
  out.views[1].mask.release();
  out.views[1].depth.release();
  return out;
}

void expect_equals_cpu(DeviceForeground& device, std::vector<ForegroundEstimator>& estimators,
                       const Observation& observation) {
  const test::DeviceFrame frame(observation, {});
  device.enqueue(frame.observation(), {});
  double sum = 0;
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    SCOPED_TRACE("view " + std::to_string(i));
    const ViewForeground expected = estimators[i].estimate(observation, i);
    const auto* found = device.pixels(static_cast<int>(i));
    const auto size = static_cast<std::size_t>(expected.pixels.width()) *
                      static_cast<std::size_t>(expected.pixels.height());
    ASSERT_EQ(found == nullptr, size == 0);
    if (!found) continue;
    const std::vector<std::uint32_t> words = test::download(found, size, {});
    EXPECT_TRUE(std::equal(words.begin(), words.end(), expected.pixels.row(0)));
    sum += expected.sum;
  }
  EXPECT_GT(sum, 100);
  const auto fractions = test::download(device.sum(), 1, {})[0];
  EXPECT_NEAR(static_cast<double>(fractions) / 65535 / sum, 1, 1e-4);
}

class SkinOnDevice : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }
};

TEST_F(SkinOnDevice, SeesTheForegroundAsTheCpu) {
  for (const Foreground foreground :
       {Foreground::automatic, Foreground::color, Foreground::mask, Foreground::depth}) {
    SCOPED_TRACE(enum_names(foreground)[static_cast<std::size_t>(foreground)]);
    Settings settings;
    settings.foreground = foreground;
    DeviceForeground device(settings);
    std::vector<ForegroundEstimator> estimators(3, ForegroundEstimator(settings));
    expect_equals_cpu(device, estimators, box_in_views(0));
  }
}

TEST_F(SkinOnDevice, SeesBeforeAKnownBackgroundAsTheCpu) {
  Settings settings;
  settings.foreground = Foreground::color;
  settings.still_cameras = true;
  DeviceForeground device(settings);
  std::vector<ForegroundEstimator> estimators(3, ForegroundEstimator(settings));
  Observation observation = box_in_views(0);
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {
    cv::cvtColor(observation.views[i].color, observation.views[i].background, cv::COLOR_BGR2BGRA);
    observation.views[i].background(cv::Rect(30, 30, 40, 40)).setTo(cv::Scalar(90, 90, 90, 255));
    observation.views[i].background(cv::Rect(50, 20, 20, 40)).setTo(cv::Scalar(0, 0, 0, 0));
  }
  expect_equals_cpu(device, estimators, observation);
}

TEST_F(SkinOnDevice, LearnsColoursOnTheFramesThatTheCpuLearnsOn) {
  Settings settings;
  settings.foreground = Foreground::color;
  settings.learn_frames = 2;
  DeviceForeground device(settings);
  std::vector<ForegroundEstimator> estimators(3, ForegroundEstimator(settings));
  for (const int number : {0, 0, 1, 2}) {
    SCOPED_TRACE(number);
    Observation observation = box_in_views(number);
    observation.start[0] += 0.01 * number;  // what is learned there is another thing
    expect_equals_cpu(device, estimators, observation);
  }
}

TEST_F(SkinOnDevice, ItsMemoryStaysWhereItIs) {
  DeviceForeground device({});
  const Observation observation = box_in_views(0);
  const test::DeviceFrame frame(observation, {});
  device.enqueue(frame.observation(), {});
  const auto* pixels = device.pixels(0);
  const auto* sum = device.sum();
  device.enqueue(frame.observation(), {});
  EXPECT_EQ(device.pixels(0), pixels);
  EXPECT_EQ(device.sum(), sum);
}

TEST_F(SkinOnDevice, ScoresAsTheCpu) {
  const Scene hand = test::hand_scene(), both = test::hand_and_box_scene();
  for (const Foreground foreground : {Foreground::mask, Foreground::color}) {
    for (const double spill : {1.0, 0.3}) {
      Params params;
      params.foreground = foreground;
      params.spill = spill;
      const auto make = [params] { return std::make_shared<Skin>(params); };
      test::expect_like_the_cpu(hand, test::colored(test::rectified_pair(hand, 256)), make);
      test::expect_like_the_cpu(both, test::colored(test::general_pair(both, 256)), make);
    }
  }
}

std::string refusal_on_device(const Observation& observation, Foreground foreground) {
  cuda::DeviceObservation frame;
  frame.header = &observation;
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    frame.tiles[i].has_color = !observation.views[i].color.empty();
    frame.tiles[i].has_mask = !observation.views[i].mask.empty();
  }
  return test::message_of<DataError>([&] { check(frame, foreground); });
}

TEST(SkinWithoutDevice, RefusesWhatTheCpuRefusesInItsWords) {
  Observation observation = colored_box();
  for (const Foreground foreground : {Foreground::mask, Foreground::depth}) {
    EXPECT_EQ(refusal_on_device(observation, foreground),
              test::message_of<DataError>([&] { check(observation, foreground); }));
  }
}

TEST(SkinWithoutDevice, HasADevicePart) { EXPECT_TRUE(make_device_objective({})); }

}  // namespace
}  // namespace hypotrack::skin
