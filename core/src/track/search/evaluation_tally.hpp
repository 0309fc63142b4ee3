#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "track/search/optimizer_trace.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// What one search evaluated, counted where its optimizer gets the costs.
struct EvaluationTally {
  std::int64_t evaluations = 0;
  double lowest = std::numeric_limits<double>::infinity();  ///< cost that was returned
  bool on_device = false;  ///< the optimizer took costs in GPU memory, which nothing counts
  bool failed = false;     ///< a cost threw
  OptimizerTracer* tracer = nullptr;  ///< gets a step after every batch; null: nothing does

  /// Calls a function that evaluates `points` points, and remembers if it throws.
  template <class Function>
  decltype(auto) count(Eigen::Index points, Function&& function) {
    try {
      evaluations += points;
      return std::forward<Function>(function)();
    } catch (...) {
      failed = true;
      throw;
    }
  }
  /// Adds the costs of points that were counted.
  void add(const Eigen::Ref<const Eigen::VectorXd>& costs) {
    for (const double cost : costs) lowest = std::min(lowest, cost);
    trace();
  }
  /// Traces what was counted so far.
  void trace() {
    if (tracer) tracer->add(evaluations, lowest);
  }
};

/// Checks an optimizer's answer by the contract of Optimizer::minimize() and replaces its count of
/// evaluations by the tally's. `who`: the optimizer. Throws PluginError.
void check_answer(OptimizerResult& answer, const EvaluationTally& tally, const SearchRegion& region,
                  const Budget& budget, const std::string& who);

}  // namespace internal
}  // namespace hypotrack
