#include "track/search_trace.hpp"

#include "hypotrack/search.hpp"

namespace hypotrack::internal {
SearchTracer::SearchTracer(TracedSearch& search)
    : search_(search),
      cpu_begin_(seconds_of(SearchClock::cpu)),
      wall_begin_(seconds_of(SearchClock::wall)) {}

void SearchTracer::add(std::int64_t evaluations, double cost) {
  if (!search_.steps.empty()) {
    const TraceStep& last = search_.steps.back();
    if (last.evaluations == evaluations && last.cost == cost) return;
  }
  search_.steps.push_back({evaluations, cost, seconds_of(SearchClock::cpu) - cpu_begin_,
                           seconds_of(SearchClock::wall) - wall_begin_});
}

}  // namespace hypotrack::internal
