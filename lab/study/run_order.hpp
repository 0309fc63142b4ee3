#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <span>

#include "base/exported.hpp"
#include "lab/study/plan.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// Chooses the order of runs. Seeds are made one after the other, as recordings of two at most are
/// on the disk. Of a seed, runs that took long with earlier seeds begin first: a long one that
/// begins last is alone at the end, while other cores and GPUs wait.
class RunOrder {
 public:
  /// The plan must outlive the object.
  explicit RunOrder(const Plan& plan) : plan_(plan) {}

  /// Takes the time of a run.
  void took(std::size_t run, double seconds) { seconds_[plan_.runs[run].cell] = seconds; }

  /// Returns which of some runs, in the order of the plan, is to begin. Runs of cells without a
  /// time come first. Precondition: there are some.
  std::size_t next(std::span<const std::size_t> runs) const {
    std::size_t best = runs.front();
    for (const std::size_t run : runs)
      if (plan_.runs[run].seed == plan_.runs[runs.front()].seed && seconds(run) > seconds(best))
        best = run;
    return best;
  }

 private:
  double seconds(std::size_t run) const {
    const auto known = seconds_.find(plan_.runs[run].cell);
    return known == seconds_.end() ? std::numeric_limits<double>::infinity() : known->second;
  }

  const Plan& plan_;
  std::map<std::size_t, double> seconds_;  ///< by cell
};

}  // namespace internal
}  // namespace hypotrack::study
