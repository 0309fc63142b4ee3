#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "base/exported.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/recordings.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// Chooses the order of runs. Seeds are made one after the other, as recordings of two at most are
/// on the disk. Of a seed, runs that took long with earlier seeds begin first: a long one that
/// begins last is alone at the end, while other cores and GPUs wait. Of several GPUs, each makes
/// the runs that read the same pictures, which its worker keeps, before it helps another. Runs
/// without a time that begin on it together read different ones, for each is read once while others
/// wait.
class RunOrder {
 public:
  /// The plan must outlive the object.
  explicit RunOrder(const Plan& plan) : plan_(plan) {
    for (const PlannedRun& run : plan.runs) pictures_.push_back(recording_id(plan, run));
  }

  /// Takes the time of a run.
  void took(std::size_t run, double seconds) { seconds_[plan_.runs[run].cell] = seconds; }

  /// Returns which of some runs, in the order of the plan, is to begin on a GPU, if that is known.
  /// Runs of cells without a time come first. Precondition: there are some.
  std::size_t next(std::span<const std::size_t> runs, std::optional<int> gpu = std::nullopt) const {
    std::size_t best = runs.front();
    for (const std::size_t run : runs)
      if (plan_.runs[run].seed == plan_.runs[runs.front()].seed && rank(run, gpu) > rank(best, gpu))
        best = run;
    return best;
  }

  /// Takes a run that begins on a GPU.
  void begins(std::size_t run, int gpu) {
    gpus_.try_emplace(pictures_[run], gpu);
    ++begun_[pictures_[run]];
  }

 private:
  /// Returns whether no other GPU keeps the pictures of a run, how long it takes, and a number that
  /// is lower the more runs have read these pictures.
  std::tuple<bool, double, int> rank(std::size_t run, std::optional<int> gpu) const {
    const auto home = gpus_.find(pictures_[run]);
    const auto time = seconds_.find(plan_.runs[run].cell);
    const auto begun = begun_.find(pictures_[run]);
    return {!gpu || home == gpus_.end() || home->second == *gpu,
            time == seconds_.end() ? std::numeric_limits<double>::infinity() : time->second,
            begun == begun_.end() ? 0 : -begun->second};
  }

  const Plan& plan_;
  std::map<std::size_t, double> seconds_;  ///< by cell
  std::vector<std::string> pictures_;      ///< that runs read
  std::map<std::string, int> gpus_;        ///< that read them first
  std::map<std::string, int> begun_;       ///< runs on GPUs that have read them
};

}  // namespace internal
}  // namespace hypotrack::study
