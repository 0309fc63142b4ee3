#include "track/search_trace.hpp"

#include <chrono>
#include <ctime>

namespace hypotrack {
namespace {

double cpu_clock() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

SearchTracer::SearchTracer(TracedSearch& search)
    : search_(search), cpu_begin_(cpu_clock()), wall_begin_(wall_clock()) {}

void SearchTracer::add(std::int64_t evaluations, double cost) {
  if (!search_.steps.empty()) {
    const TraceStep& last = search_.steps.back();
    if (last.evaluations == evaluations && last.cost == cost) return;
  }
  search_.steps.push_back(
      {evaluations, cost, cpu_clock() - cpu_begin_, wall_clock() - wall_begin_});
}

}  // namespace hypotrack
