#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The state of a search after a batch of evaluations. Times count from its beginning.
struct TraceStep {
  std::int64_t evaluations = 0;                           ///< so far, those of Jacobians included
  double cost = std::numeric_limits<double>::infinity();  ///< lowest so far
  double cpu_seconds = 0;                                 ///< of the whole process
  double wall_seconds = 0;
};

/// One call of the scene's optimizer, batch by batch.
struct OptimizerTrace {
  int dimension = 0;                                             ///< length of a search point
  double truth_cost = std::numeric_limits<double>::quiet_NaN();  ///< of the true state, in the same
                                                                 ///< tiles; NaN: unknown
  std::vector<TraceStep> steps = {};
};

/// How the searches of a frame converged, and what its answer costs.
struct FrameTrace {
  std::vector<OptimizerTrace> searches = {};  ///< in their order
  double cost =
      std::numeric_limits<double>::infinity();  ///< of the answer; infinite: there is none
  double truth_cost = std::numeric_limits<double>::quiet_NaN();  ///< in the tiles of the answer
};

/// Adds steps to a traced search. Its clocks start at construction.
class OptimizerTracer {
 public:
  /// `search` must outlive the tracer.
  explicit OptimizerTracer(OptimizerTrace& search)
      : search_(search),
        cpu_begin_(seconds_of(SearchClock::cpu)),
        wall_begin_(seconds_of(SearchClock::wall)) {}

  /// Adds a step, unless nothing was evaluated since the last one and the cost is the same.
  void add(std::int64_t evaluations, double cost) {
    if (!search_.steps.empty()) {
      const TraceStep& last = search_.steps.back();
      if (last.evaluations == evaluations && last.cost == cost) return;
    }
    search_.steps.push_back({evaluations, cost, seconds_of(SearchClock::cpu) - cpu_begin_,
                             seconds_of(SearchClock::wall) - wall_begin_});
  }

 private:
  OptimizerTrace& search_;
  double cpu_begin_, wall_begin_;
};

}  // namespace internal
}  // namespace hypotrack
