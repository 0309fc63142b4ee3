#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "device.hpp"

namespace hypotrack::live {

/// Places of two pictures in their queues.
struct PairPlaces {
  std::size_t first = 0;
  std::size_t second = 0;
};

/// Finds the newest picture of the first queue that has a partner in the second: the nearest in
/// time, at most `tolerance` nanoseconds away. Both queues are in order of time.
std::optional<PairPlaces> newest_pair(const std::deque<Picture>& first,
                                      const std::deque<Picture>& second, std::int64_t tolerance);

}  // namespace hypotrack::live
