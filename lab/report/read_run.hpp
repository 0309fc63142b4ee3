#pragma once

#include <filesystem>

#include "lab/report/study_data.hpp"

namespace hypotrack {

/// Fills in what a run folder says about its result: metrics.json and summary.json where they are,
/// failure.json for a run that failed. Throws DataError on damaged files.
void read_results(const std::filesystem::path& directory, StudyRun& run);

/// A finished or failed run of a study: its cell.json and its results.
StudyRun read_study_run(const std::filesystem::path& directory);

}  // namespace hypotrack
