#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "lab/study/plan.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// Numbers by name, in the order of the file. Nothing: undefined, as the time to loss of a run that
/// never lost.
using Metrics = std::vector<std::pair<std::string, std::optional<double>>>;

/// The result of a finished or failed run.
struct RunResult {
  const PlannedRun* run = nullptr;
  bool ok = true;
  std::string message;  ///< error message if it failed
  Metrics metrics;      ///< reproducible numbers; empty if it failed
  Metrics timing;       ///< fps, evaluations_per_second, seconds
};

/// Reads the finished runs of a plan from a study's folder. Cells are in the plan's order, seeds in
/// the study's. Throws DataError.
std::vector<RunResult> read_results(const Plan& plan, const std::filesystem::path& runs);

}  // namespace internal
}  // namespace hypotrack::study
