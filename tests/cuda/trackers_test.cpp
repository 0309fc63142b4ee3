#include <cuda_runtime.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "device.hpp"
#include "hypotrack/api/session.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

constexpr const char* kScene = R"(source:
  type: synthetic
  frames: 4
  cameras: {width: 320, height: 240, focal_px: 300, baseline_mm: 100}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 500]}}}
    - {frame: 3, pose: {box: {position_mm: [10, 5, 510]}}}
models:
  - {name: box, type: rigid_box, size_mm: [60, 90, 40]}
objective: {type: stereo_color}
optimizer: {type: pso, particles: 16, generations: 8}
tile: {size: 64}
init: {pose: {box: {position_mm: [0, 0, 500]}}}
)";

int current() {
  int device = -1;
  EXPECT_EQ(cudaGetDevice(&device), cudaSuccess);
  return device;
}

/// A test with several trackers on GPUs in one process.
class TrackersTest : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_DEVICE();
    std::ofstream(scene_) << kScene;
    PluginLoader plugins;
    const OpenedScene opened = open_source(scene_, {}, plugins);
    cameras_ = opened.source->cameras();
    while (auto frame = opened.source->next()) frames_.push_back(*std::move(frame));
  }

  Tracker tracker(int device) const {
    Session session(scene_,
                    {.set = {"evaluate.backend=cuda", "evaluate.device=" + std::to_string(device)},
                     .plugin_path = {}});
    return session.tracker(cameras_);
  }
  std::vector<Eigen::VectorXd> states(Tracker& tracker) const {
    std::vector<Eigen::VectorXd> found;
    for (const Frame& frame : frames_) found.push_back(tracker.track(frame).state);
    return found;
  }

  TemporaryDirectory folder_;
  std::filesystem::path scene_ = folder_.path() / "scene.yaml";
  std::vector<Camera> cameras_;
  std::vector<Frame> frames_;
};

TEST_F(TrackersTest, EachKeepsItsDeviceAndLeavesTheCallersAsItWas) {
  if (const std::string why = cuda::why_no_device(1); !why.empty())
    GTEST_SKIP() << "needs two GPUs: " << why;
  for (const int callers : {0, 1}) {
    ASSERT_EQ(cudaSetDevice(callers), cudaSuccess);
    Tracker first = tracker(0), second = tracker(1);
    EXPECT_EQ(current(), callers);
    for (const Frame& frame : frames_) {
      EXPECT_EQ(first.track(frame).state, second.track(frame).state);
      EXPECT_EQ(current(), callers);
    }
    EXPECT_NE(first.backend().find("GPU 0)"), std::string::npos) << first.backend();
    EXPECT_NE(second.backend().find("GPU 1)"), std::string::npos) << second.backend();
    { const Tracker gone = std::move(second); }
    EXPECT_EQ(current(), callers);
  }
}

TEST_F(TrackersTest, InThreadsFindWhatOneAloneFinds) {
  const int devices = cuda::why_no_device(1).empty() ? 2 : 1;
  Tracker alone = tracker(0);
  const auto expected = states(alone);
  std::vector<std::vector<Eigen::VectorXd>> found(4);
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([&, i] {
        Tracker own = tracker(i % devices);
        found[static_cast<std::size_t>(i)] = states(own);
      });
  }
  for (const auto& states : found) EXPECT_EQ(states, expected);
}

}  // namespace
}  // namespace hypotrack::test
