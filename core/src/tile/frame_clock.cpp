#include "tile/frame_clock.hpp"

#include <algorithm>

namespace hypotrack::internal {

void FrameClock::take(Frame& frame) {
  constexpr double kIntervals = 10, kSeconds = 0.5;  // cameras drop some frames now and then
  const double longest = std::max(kIntervals * interval_, kSeconds);
  // A single wrong time moves no later ones.
  if (added_ != 0 && last_ && frame.time > *last_ && frame.time - *last_ <= longest) added_ = 0;
  double time = frame.time + added_;
  if (last_ && time <= *last_) {
    time = *last_ + interval_;
    added_ = time - frame.time;
    frame.fault = FrameFault::time_back;
  } else if (last_ && !live_ && time - *last_ > longest) {
    frame.fault = FrameFault::time_gap;
  }
  frame.time = time;
  last_ = time;
}

}  // namespace hypotrack::internal
