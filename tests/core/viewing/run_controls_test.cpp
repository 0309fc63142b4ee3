#include "viewing/run_controls.hpp"

#include <gtest/gtest.h>

namespace hypotrack {
namespace {

TEST(RunControls, DoNotWaitWithoutPause) {
  RunControls controls;
  controls.wait_while_paused([] { return ADD_FAILURE(), false; });
  EXPECT_FALSE(controls.paused());
}

TEST(RunControls, WaitUntilResumed) {
  RunControls controls;
  controls.pause();
  int waits = 0;
  controls.wait_while_paused([&] {
    if (++waits == 3) controls.resume();
    return true;
  });
  EXPECT_EQ(waits, 3);
}

TEST(RunControls, StopWaitingWhenInterrupted) {
  RunControls controls;
  controls.pause();
  controls.wait_while_paused([] { return false; });
  EXPECT_TRUE(controls.paused());
}

TEST(RunControls, AStepLetsOneFramePass) {
  RunControls controls;
  controls.step();
  controls.step();
  int waits = 0;
  const auto count = [&] { return ++waits, false; };
  controls.wait_while_paused(count);
  controls.wait_while_paused(count);
  EXPECT_EQ(waits, 0);
  controls.wait_while_paused(count);
  EXPECT_EQ(waits, 1);
  EXPECT_TRUE(controls.paused());
}

TEST(RunControls, WishesAreTakenOnce) {
  RunControls controls;
  EXPECT_FALSE(controls.take_restart());
  EXPECT_FALSE(controls.take_snapshot());
  controls.ask_for_restart();
  controls.ask_for_snapshot();
  EXPECT_TRUE(controls.take_restart());
  EXPECT_TRUE(controls.take_snapshot());
  EXPECT_FALSE(controls.take_restart());
  EXPECT_FALSE(controls.take_snapshot());
}

TEST(RunControls, ARunThatShallEndDoesNotWait) {
  RunControls controls;
  controls.pause();
  int waits = 0;
  controls.wait_while_paused([&] {
    if (++waits == 2) controls.ask_for_end();
    return true;
  });
  EXPECT_EQ(waits, 2);
  EXPECT_TRUE(controls.end_wanted());
}

TEST(RunControls, ARecordingIsWantedUntilToggledOrCancelled) {
  RunControls controls;
  controls.toggle_recording();
  EXPECT_TRUE(controls.recording_wanted());
  controls.toggle_recording();
  EXPECT_FALSE(controls.recording_wanted());
  controls.toggle_recording();
  controls.cancel_recording();
  EXPECT_FALSE(controls.recording_wanted());
}

}  // namespace
}  // namespace hypotrack
