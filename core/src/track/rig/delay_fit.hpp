#pragma once

#include <deque>
#include <optional>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// How models move across the rows of a rectified pair in a frame, in units of y/z.
struct RowMotion {
  double time = 0;   ///< seconds
  double speed = 0;  ///< downwards, per second
  double rows = 0;   ///< by which the second view shows them lower than the first
};

/// By how many seconds the second view is late, and the standard deviation of that.
struct Delay {
  double seconds = 0;
  double sigma = 0;
};

/// Tells from models that move up and down how late the second view of a pair is: it shows them
/// where they were. Nothing else makes rows follow the speed.
class DelayFit {
 public:
  /// Adds a frame. Forgets those of more than some seconds ago.
  void add(const RowMotion& motion);

  /// Returns the delay if it surely exceeds `least` seconds in either direction, in the older and
  /// in the newer half of the frames alike.
  std::optional<Delay> beyond(double least) const;
  /// Returns the delay that all remembered frames tell. The sigma is infinite for few of them.
  Delay estimate() const;

 private:
  std::deque<RowMotion> frames_;
};

}  // namespace internal
}  // namespace hypotrack
