#pragma once

#include <filesystem>

#include "base/exported.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads the results of a run folder: metrics.json and summary.json if they exist, failure.json for
/// a run that failed. Throws DataError on damaged files.
void read_results(const std::filesystem::path& directory, StudyRun& run);

/// Reads a finished or failed run of a study: its cell.json and its results.
StudyRun read_study_run(const std::filesystem::path& directory);

}  // namespace internal
}  // namespace hypotrack
