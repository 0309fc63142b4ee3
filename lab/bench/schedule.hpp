#pragma once

#include "hypotrack/export.hpp"

namespace hypotrack::bench {

/// A measurement goes on past its time until it has so many frames, but not past a multiple of it.
inline constexpr int kFewestFrames = 3;
inline constexpr double kLongest = 3;

/// How much is measured of every case in every way.
struct Limits {
  int frames = 50;
  int warm_up = 5;      ///< frames that are tracked before; fewer of a slow way or a short source
  double seconds = 10;  ///< for warm-up and frames
};

/// Decides which frames of a sequence count, and when there are enough of them. Times are in
/// seconds since the first frame began.
class HYPOTRACK_API Schedule {
 public:
  /// `usable` is the number of frames that can be tracked. Of a short sequence, one frame at most
  /// warms up.
  Schedule(const Limits& limits, int usable);

  /// To be asked before every frame.
  bool goes_on(double seconds) const;

  /// Takes in that a frame has been tracked; whether it is one to measure. A frame that alone takes
  /// too long is.
  bool counts(double seconds);

 private:
  Limits limits_;
  int to_warm_up_;
  int measured_ = 0;
};

}  // namespace hypotrack::bench
