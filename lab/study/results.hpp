#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/study_folder.hpp"

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

/// Numbers of runs in a study's folder.
struct Tally {
  std::size_t planned = 0, ok = 0, failed = 0;
};

/// Writes results.csv (a row per run), cells.csv (a row per cell: mean and standard deviation over
/// the seeds) and timing.csv from the finished runs. Replaces each file atomically. The first two
/// have the same bytes for the same runs. Throws OutputError or DataError.
Tally write_tables(const StudyFolder& folder, const Plan& plan);

}  // namespace internal
}  // namespace hypotrack::study
