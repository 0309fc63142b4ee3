#include "lab/bench/schedule.hpp"

#include <gtest/gtest.h>

namespace hypotrack::test {
namespace {

using bench::Limits;
using bench::Schedule;

struct Counts {
  int warm_up = 0, measured = 0;
  bool operator==(const Counts&) const = default;
};

void PrintTo(const Counts& counts, std::ostream* out) {
  *out << counts.warm_up << " + " << counts.measured;
}

/// What becomes of `usable` frames that take so many seconds each.
Counts frames_of(const Limits& limits, int usable, double seconds) {
  Schedule schedule(limits, usable);
  Counts counts;
  for (int i = 0; i < usable && schedule.goes_on(i * seconds); ++i)
    ++(schedule.counts((i + 1) * seconds) ? counts.measured : counts.warm_up);
  return counts;
}

constexpr Limits kLimits{.frames = 50, .warm_up = 5, .seconds = 10};

TEST(ScheduleTest, FastFramesAreAllMeasuredAfterTheWarmUp) {
  EXPECT_EQ(frames_of(kLimits, 100, 0.01), (Counts{5, 50}));
  EXPECT_EQ(frames_of(kLimits, 55, 0.01), (Counts{5, 50}));
}

TEST(ScheduleTest, AShortSequenceWarmsUpLess) {
  EXPECT_EQ(frames_of(kLimits, 53, 0.01), (Counts{3, 50}));
  EXPECT_EQ(frames_of(kLimits, 20, 0.01), (Counts{1, 19}));
  EXPECT_EQ(frames_of(kLimits, 2, 0.01), (Counts{1, 1}));
  EXPECT_EQ(frames_of(kLimits, 1, 0.01), (Counts{0, 1}));
  EXPECT_EQ(frames_of({.frames = 50, .warm_up = 0, .seconds = 10}, 20, 0.01), (Counts{0, 20}));
}

TEST(ScheduleTest, SlowFramesAreFewer) {
  EXPECT_EQ(frames_of(kLimits, 100, 0.6), (Counts{5, 12}));
  EXPECT_EQ(frames_of(kLimits, 100, 1), (Counts{3, 8}));
  EXPECT_EQ(frames_of(kLimits, 100, 3), (Counts{1, 3}));
}

TEST(ScheduleTest, ThereAreThreeOfThemUnlessThatTakesThreeTimesAsLong) {
  EXPECT_EQ(frames_of(kLimits, 100, 7), (Counts{1, 3}));
  EXPECT_EQ(frames_of(kLimits, 100, 12), (Counts{1, 2}));
  EXPECT_EQ(frames_of(kLimits, 100, 20), (Counts{1, 1}));
  EXPECT_EQ(frames_of(kLimits, 100, 40), (Counts{0, 1}));
}

}  // namespace
}  // namespace hypotrack::test
