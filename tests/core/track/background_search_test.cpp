#include "track/loop/background_search.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "hypotrack/api/stop.hpp"

namespace hypotrack {
namespace {

Frame grey_frame() {
  Frame frame;
  frame.views.resize(1);
  frame.views[0].color = cv::Mat(4, 4, CV_8UC3, cv::Scalar(90, 90, 90));
  return frame;
}

Candidate result_of(BackgroundSearch& background) {
  while (true) {
    if (std::optional<Candidate> found = background.take()) return *found;
    std::this_thread::yield();
  }
}

TEST(BackgroundSearch, GivesItsResultOnceAndNothingBefore) {
  BackgroundSearch background(2);
  EXPECT_FALSE(background.is_running());
  std::atomic<bool> may_end = false;
  background.start(grey_frame(), [&](const Frame&) {
    while (!may_end) std::this_thread::yield();
    Candidate found;
    found.found.cost = 3;
    return found;
  });
  EXPECT_FALSE(background.take());
  EXPECT_TRUE(background.is_running());
  may_end = true;
  EXPECT_EQ(result_of(background).found.cost, 3);
  EXPECT_FALSE(background.is_running());
}

TEST(BackgroundSearch, SearchesACopyOfTheFrameWhoseImagesTheSourceReuses) {
  Frame frame = grey_frame();
  std::atomic<bool> may_look = false;
  BackgroundSearch background(2);
  background.start(frame, [&](const Frame& copy) {
    while (!may_look) std::this_thread::yield();
    Candidate found;
    found.found.cost = copy.views[0].color.at<cv::Vec3b>(0, 0)[0];
    return found;
  });
  frame.views[0].color.setTo(0);
  may_look = true;
  EXPECT_EQ(result_of(background).found.cost, 90);
}

TEST(BackgroundSearch, ThrowsWhatTheSearchThrew) {
  BackgroundSearch background(2);
  background.start(grey_frame(), [](const Frame&) -> Candidate { throw std::runtime_error("no"); });
  EXPECT_THROW(result_of(background), std::runtime_error);
  EXPECT_FALSE(background.is_running());
}

TEST(BackgroundSearch, EndsWhenItIsCancelledAndBeginsAgain) {
  const auto endless = [](const Frame&) -> Candidate {
    while (true) check_stop();
  };
  BackgroundSearch background(2);
  background.cancel();
  background.start(grey_frame(), endless);
  background.cancel();
  EXPECT_FALSE(background.is_running());
  background.start(grey_frame(), [](const Frame&) {
    check_stop();
    return Candidate();
  });
  result_of(background);
  background.start(grey_frame(), endless);  // ends with the object
}

}  // namespace
}  // namespace hypotrack
