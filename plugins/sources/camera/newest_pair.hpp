#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
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
inline std::optional<PairPlaces> newest_pair(const std::deque<Picture>& first,
                                             const std::deque<Picture>& second,
                                             std::int64_t tolerance) {
  for (std::size_t i = first.size(); i-- > 0;) {
    const auto distance = [&](const Picture& other) {
      return std::abs(other.stamp - first[i].stamp);
    };
    const auto nearest = std::ranges::min_element(second, {}, distance);
    if (nearest == second.end() || distance(*nearest) > tolerance) continue;
    return PairPlaces{i, static_cast<std::size_t>(nearest - second.begin())};
  }
  return std::nullopt;
}

}  // namespace hypotrack::live
