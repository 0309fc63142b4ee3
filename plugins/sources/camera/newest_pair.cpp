#include "newest_pair.hpp"

#include <algorithm>
#include <cstdlib>

namespace hypotrack::live {

std::optional<PairPlaces> newest_pair(const std::deque<Picture>& first,
                                      const std::deque<Picture>& second, std::int64_t tolerance) {
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
