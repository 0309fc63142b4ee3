#include "tile/frame_clock.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hypotrack {
namespace {

struct Ticks {
  std::vector<double> times;
  std::vector<FrameFault> faults;
};

Ticks taken(const std::vector<double>& times, bool live = false) {
  FrameClock clock(10, live);
  Ticks out;
  for (const double time : times) {
    Frame frame;
    frame.time = time;
    clock.take(frame);
    out.times.push_back(frame.time);
    out.faults.push_back(frame.fault);
  }
  return out;
}

constexpr FrameFault kNone = FrameFault::none, kBack = FrameFault::time_back,
                     kGap = FrameFault::time_gap;

TEST(FrameClock, LeavesTimesThatGrowAsTheyAre) {
  const std::vector<double> times{0, 0.1, 0.2, 0.5, 0.52, 1.5};
  EXPECT_EQ(taken(times).times, times);
  EXPECT_EQ(taken(times).faults, std::vector<FrameFault>(6, kNone)) << "cameras drop some frames";
}

TEST(FrameClock, MovesASingleWrongTimeAlone) {
  const Ticks ticks = taken({5, 5.1, 0.3, 5.3});
  EXPECT_DOUBLE_EQ(ticks.times[2], 5.2);
  EXPECT_DOUBLE_EQ(ticks.times[3], 5.3);
  EXPECT_EQ(ticks.faults, (std::vector<FrameFault>{kNone, kNone, kBack, kNone}));
}

TEST(FrameClock, GoesOnBehindAClockThatWasSetBack) {
  const Ticks ticks = taken({5, 5.1, 0, 0.1, 0.25});
  EXPECT_DOUBLE_EQ(ticks.times[2], 5.2);
  EXPECT_DOUBLE_EQ(ticks.times[3], 5.3);
  EXPECT_DOUBLE_EQ(ticks.times[4], 5.45);
  EXPECT_EQ(ticks.faults, (std::vector<FrameFault>{kNone, kNone, kBack, kNone, kNone}));
}

TEST(FrameClock, PartsEqualTimes) {
  const Ticks ticks = taken({0, 0, 0.2, 0.2});
  EXPECT_DOUBLE_EQ(ticks.times[1], 0.1);
  EXPECT_DOUBLE_EQ(ticks.times[2], 0.2);
  EXPECT_DOUBLE_EQ(ticks.times[3], 0.3);
  EXPECT_EQ(ticks.faults, (std::vector<FrameFault>{kNone, kBack, kNone, kBack}));
}

TEST(FrameClock, NoticesGapsOfRecordingsOnly) {
  EXPECT_EQ(taken({0, 0.1, 3, 3.1}).faults, (std::vector<FrameFault>{kNone, kNone, kGap, kNone}));
  EXPECT_EQ(taken({0, 0.1, 3, 3.1}, true).faults, std::vector<FrameFault>(4, kNone))
      << "a live camera waits for nobody";
}

}  // namespace
}  // namespace hypotrack
