#pragma once

#include <chrono>
#include <cmath>
#include <deque>

namespace hypotrack {

/// Frames per second over the last frames.
class FrameRate {
 public:
  using Clock = std::chrono::steady_clock;

  void add(Clock::time_point now) {
    constexpr std::size_t kTimes = 30;
    times_.push_back(now);
    if (times_.size() > kTimes) times_.pop_front();
  }

  /// Forgets the frames so far, for example before a pause.
  void clear() { times_.clear(); }

  /// Returns NaN while fewer than two frames are known.
  double per_second() const {
    if (times_.size() < 2) return std::nan("");
    const std::chrono::duration<double> elapsed = times_.back() - times_.front();
    return static_cast<double>(times_.size() - 1) / elapsed.count();
  }

 private:
  std::deque<Clock::time_point> times_;
};

}  // namespace hypotrack
