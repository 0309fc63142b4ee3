#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/export.hpp"
#include "lab/study/plan.hpp"

namespace hypotrack::study {

/// Numbers by name, in the order in which they were written; nothing where a number is undefined
/// (the time to loss of a run that never lost).
using Metrics = std::vector<std::pair<std::string, std::optional<double>>>;

/// A run that is there.
struct RunResult {
  const PlannedRun* run = nullptr;
  bool ok = true;
  std::string message;  ///< why it failed
  Metrics metrics;      ///< the same twice; empty if it failed
  Metrics timing;       ///< fps, evaluations_per_second, seconds
};

/// Reads the runs of a plan that are in a study's folder, sorted as the tables are: cells in the
/// plan's order, seeds in the study's. Throws DataError.
std::vector<RunResult> read_results(const Plan& plan, const std::filesystem::path& runs);

/// Mean and spread of some numbers.
struct Statistics {
  std::size_t count = 0;
  double mean = 0;
  std::optional<double> sd;  ///< of the sample (divided by n - 1); nothing for fewer than two
};
HYPOTRACK_API Statistics statistics_of(const std::vector<double>& values);

}  // namespace hypotrack::study
