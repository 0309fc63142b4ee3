#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// The pictures of one moment.
struct TimedFrame {
  std::int64_t time = 0;  ///< of the first view that has a picture, nanoseconds
  std::vector<std::optional<std::size_t>> pictures;  ///< by view: index in its times, or none

  HYPOTRACK_API bool complete() const;  ///< whether every view has a picture
};

/// Returns the index of the nearest time, the earlier of two. `times` must ascend, and not be
/// empty.
HYPOTRACK_API std::size_t nearest_in_time(std::span<const std::int64_t> times, std::int64_t time);

/// Puts the pictures of several views together by their times, nanoseconds that ascend in each
/// view. Pictures are of one frame if each is the other's nearest and they are at most `tolerance`
/// apart. A picture without a partner makes a frame of its own. The frames ascend.
HYPOTRACK_API std::vector<TimedFrame> pair_by_time(std::span<const std::vector<std::int64_t>> views,
                                                   std::int64_t tolerance);

}  // namespace hypotrack
