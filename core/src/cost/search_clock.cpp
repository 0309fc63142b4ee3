#include "cost/search_clock.hpp"

#include <chrono>
#include <ctime>
#include <utility>

namespace hypotrack {
namespace {

thread_local SearchClock clock_of_thread = SearchClock::wall;

}  // namespace

SearchClock search_clock() { return clock_of_thread; }

double seconds_of(SearchClock clock) {
  if (clock == SearchClock::wall)
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace hypotrack

namespace hypotrack::internal {

ClockScope::ClockScope(SearchClock clock) : before_(std::exchange(clock_of_thread, clock)) {}

ClockScope::~ClockScope() { clock_of_thread = before_; }

}  // namespace hypotrack::internal
