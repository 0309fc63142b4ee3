#include "lab/study/run_order.hpp"

#include <limits>

namespace hypotrack::study::internal {

std::size_t RunOrder::next(std::span<const std::size_t> runs) const {
  const auto seconds = [&](std::size_t run) {
    const auto known = seconds_.find(plan_.runs[run].cell);
    return known == seconds_.end() ? std::numeric_limits<double>::infinity() : known->second;
  };
  std::size_t best = runs.front();
  for (const std::size_t run : runs)
    if (plan_.runs[run].seed == plan_.runs[runs.front()].seed && seconds(run) > seconds(best))
      best = run;
  return best;
}

}  // namespace hypotrack::study::internal
