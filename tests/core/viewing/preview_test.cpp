#include "viewing/preview.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <mutex>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <thread>

#include "live_world.hpp"

namespace hypotrack::test {
namespace {

/// A window without a screen: draws whenever it shall and presses one key.
struct FakeWindow {
  static void show(const WindowContent& content) {
    cv::Mat shown = content.picture(content.size);
    if (key != 0) content.on_key(key);
    WindowStep step = WindowStep::wait;
    while ((step = content.next()) != WindowStep::close) {
      if (step != WindowStep::redraw) std::this_thread::yield();
      if (step == WindowStep::redraw) shown = content.picture(content.size);
      const std::lock_guard lock(mutex);
      newest = shown;
    }
  }
  static void is_closed(const WindowContent& content) { content.picture(content.size); }
  static void fails(const WindowContent& /*content*/) { throw std::runtime_error("no windows"); }

  static inline std::mutex mutex;
  static inline cv::Mat newest;
  static inline char key = 0;
};

class PreviewTest : public testing::Test {
 protected:
  void SetUp() override {
    FakeWindow::key = 0;
    FakeWindow::newest.release();
  }
  std::unique_ptr<Viewer> open(ShowWindow show) {
    auto viewer =
        make_preview(controls_, show, [this](const std::string& text) { warned_.set_value(text); });
    viewer->open(world_.scene, world_.cameras);
    viewer->begin(10);
    return viewer;
  }
  /// Waits until the window's picture has the models drawn on grey views.
  static bool wait_for_models() {
    while (true) {
      const std::lock_guard lock(FakeWindow::mutex);
      if (FakeWindow::newest.empty()) continue;
      cv::Mat grey;
      cv::inRange(FakeWindow::newest, cv::Scalar::all(90), cv::Scalar::all(90), grey);
      const double share = 1.0 * cv::countNonZero(grey) / static_cast<double>(grey.total());
      if (share > 0.5) return share < 0.85;
    }
  }

  LiveWorld world_;
  RunControls controls_;
  std::promise<std::string> warned_;
};

TEST_F(PreviewTest, DrawsTheNewestFrameInAThreadOfItsOwn) {
  const auto viewer = open(FakeWindow::show);
  viewer->frame(world_.live(0));
  EXPECT_TRUE(wait_for_models());
  viewer->end();
  viewer->say("after the scene");
  EXPECT_FALSE(controls_.end_wanted());
}

TEST_F(PreviewTest, ItsKeysSteerTheRun) {
  FakeWindow::key = 's';
  const auto viewer = open(FakeWindow::show);
  while (!controls_.take_snapshot()) std::this_thread::yield();
  EXPECT_FALSE(controls_.paused());
}

TEST_F(PreviewTest, AClosedWindowEndsTheRun) {
  const auto viewer = open(FakeWindow::is_closed);
  while (!controls_.end_wanted()) std::this_thread::yield();
  viewer->frame(world_.live(0));
  viewer->end();
}

TEST_F(PreviewTest, AWindowThatFailsLetsTheRunGoOn) {
  controls_.pause();
  const auto viewer = open(FakeWindow::fails);
  EXPECT_THAT(warned_.get_future().get(), testing::AllOf(testing::HasSubstr("the run goes on"),
                                                         testing::HasSubstr("no windows")));
  viewer->frame(world_.live(0));
  viewer->end();
  EXPECT_FALSE(controls_.end_wanted());
  EXPECT_FALSE(controls_.paused()) << "nobody could make it go on";
}

}  // namespace
}  // namespace hypotrack::test
