#include "lab/bench/schedule.hpp"

#include <algorithm>

namespace hypotrack::bench::internal {
namespace {

/// The warm-up ends at this share of the total time.
constexpr double kWarmUpShare = 0.25;

int warm_up_of(const Limits& limits, int usable) {
  const int least = std::clamp(usable - 1, 0, std::min(1, limits.warm_up));
  return std::clamp(usable - limits.frames, least, limits.warm_up);
}

}  // namespace

Schedule::Schedule(const Limits& limits, int usable)
    : limits_(limits), to_warm_up_(warm_up_of(limits, usable)) {}

bool Schedule::goes_on(double seconds) const {
  const bool late = seconds > limits_.seconds && measured_ >= kFewestFrames;
  const bool too_late = seconds > kLongest * limits_.seconds && measured_ > 0;
  return measured_ < limits_.frames && !late && !too_late;
}

bool Schedule::counts(double seconds) {
  if (to_warm_up_ > 0 && seconds <= kLongest * limits_.seconds) {
    to_warm_up_ = seconds > kWarmUpShare * limits_.seconds ? 0 : to_warm_up_ - 1;
    return false;
  }
  ++measured_;
  return true;
}

}  // namespace hypotrack::bench::internal
