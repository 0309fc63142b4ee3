#pragma once

#include "base/exported.hpp"

namespace hypotrack::bench {
inline namespace HYPOTRACK_EXPORTED internal {

/// Least number of frames. A measurement exceeds its time to reach it, but only up to kLongest
/// times.
inline constexpr int kFewestFrames = 3;
inline constexpr double kLongest = 3;

/// Amount to measure of every case in every configuration.
struct Limits {
  int frames = 50;
  int warm_up = 5;      ///< frames tracked before; fewer for a slow configuration or a short source
  double seconds = 10;  ///< for warm-up and measured frames
};

/// Decides which frames of a sequence are measured, and when to stop. Times are in seconds since
/// the first frame began.
class Schedule {
 public:
  /// `usable` is the number of frames that can be tracked. A short sequence has at most one warm-up
  /// frame.
  Schedule(const Limits& limits, int usable);

  /// Returns whether to track another frame. Call it before every frame.
  bool goes_on(double seconds) const;

  /// Records a tracked frame and returns whether it is measured. A frame that alone takes too long
  /// is measured.
  bool counts(double seconds);

 private:
  Limits limits_;
  int to_warm_up_;
  int measured_ = 0;
};

}  // namespace internal
}  // namespace hypotrack::bench
