#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/media.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// When the frames of a video were taken.
struct VideoClock {
  double rate = 30;   ///< frames per second; of an uneven video, one over the median step
  bool even = true;   ///< most frames are one step apart
  bool exact = true;  ///< times are numbers over the rate, from `first` on
  double first = 0;   ///< time of the first frame, seconds
  double last = 0;
  std::vector<double> times;          ///< seconds since the first frame
  std::vector<std::int64_t> numbers;  ///< of the frames, from 0; of an even video, gaps count
};

/// Returns the clock of a video, or one of a constant rate without gaps if `rate` is given.
VideoClock clock_of(const VideoInfo& video, const std::optional<double>& rate);

}  // namespace internal
}  // namespace hypotrack
