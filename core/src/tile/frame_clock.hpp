#pragma once

#include <algorithm>
#include <limits>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Corrects times that do not grow, and notices gaps.
class FrameClock {
 public:
  /// Frames of a live source come as fast as they are taken: it has no gaps.
  FrameClock(double frame_rate, bool live) : interval_(1 / frame_rate), live_(live) {}

  /// Takes the next frame. If its time is not after the last one's, it becomes one interval later,
  /// and those of later frames follow. Sets Frame::fault.
  void take(Frame& frame) {
    constexpr double kIntervals = 10, kSeconds = 0.5;  // cameras drop some frames now and then
    const double longest = std::max(kIntervals * interval_, kSeconds);
    // A single wrong time moves no later ones.
    if (added_ != 0 && frame.time > last_ && frame.time - last_ <= longest) added_ = 0;
    double time = frame.time + added_;
    if (time <= last_) {
      time = last_ + interval_;
      added_ = time - frame.time;
      frame.fault = FrameFault::time_back;
    } else if (!live_ && time - last_ > longest) {
      frame.fault = FrameFault::time_gap;
    }
    frame.time = time;
    last_ = time;
  }

 private:
  double interval_;
  bool live_;
  /// Corrected time of the last frame; NaN, which no time is before or after: there was none.
  double last_ = std::numeric_limits<double>::quiet_NaN();
  double added_ = 0;  ///< to the times of the source
};

}  // namespace internal
}  // namespace hypotrack
