#pragma once

#include <optional>

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
  void take(Frame& frame);

 private:
  double interval_;
  bool live_;
  std::optional<double> last_;  ///< time of the last frame, corrected
  double added_ = 0;            ///< to the times of the source
};

}  // namespace internal
}  // namespace hypotrack
