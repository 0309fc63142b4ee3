#include "cost/search_clock.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace hypotrack {
namespace {

TEST(SearchClock, IsWallTimeOutsideOfAScope) {
  EXPECT_EQ(search_clock(), SearchClock::wall);
  {
    const ClockScope cpu(SearchClock::cpu);
    EXPECT_EQ(search_clock(), SearchClock::cpu);
    const ClockScope wall(SearchClock::wall);
    EXPECT_EQ(search_clock(), SearchClock::wall);
  }
  EXPECT_EQ(search_clock(), SearchClock::wall);
}

TEST(SearchClock, ADeadlineKeepsTheClockOfItsBegin) {
  const Deadline wall(1000);
  const auto cpu = [] {
    const ClockScope scope(SearchClock::cpu);
    return Deadline(1000);
  }();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // takes no CPU time
  const double cpu_left = cpu.left();
  EXPECT_GT(cpu_left, wall.left());
}

TEST(SearchClock, ADeadlineOfCpuTimePassesWithWork) {
  const ClockScope scope(SearchClock::cpu);
  const Deadline deadline(1e-3);
  while (!deadline.passed()) {
  }
  EXPECT_GE(seconds_of(SearchClock::cpu), 1e-3);
}

}  // namespace
}  // namespace hypotrack
