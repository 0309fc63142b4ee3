#pragma once

#include <span>
#include <string>
#include <vector>

#include "camera/timeline/video_clock.hpp"
#include "hypotrack/api/timeline.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The clocks of two videos, and how they relate.
struct VideoPair {
  std::span<const VideoInfo> videos;
  VideoClock left, right;
  double shift = 0;      ///< of the right clock from the left one, seconds
  double tolerance = 0;  ///< of times within a pair, seconds

  /// Returns the lower of the frame rates.
  double slower() const;
  /// Returns how many frames the left video takes in the time of a frame of the pair.
  int thinning() const;
  /// Returns the time of a right frame on the left clock, since its first frame.
  double right_time(std::size_t i) const;
  /// Returns the time between the pictures of a complete frame, seconds.
  double distance(const TimelineFrame& frame) const;
};

/// Relates the clocks and pairs the frames. Throws DataError as make_timeline().
std::vector<TimelineFrame> pair_frames(VideoPair& pair, const TimelineSettings& settings,
                                       std::vector<std::string>& notes);

}  // namespace internal
}  // namespace hypotrack
