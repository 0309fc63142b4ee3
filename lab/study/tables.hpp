#pragma once

#include <cstddef>

#include "hypotrack/export.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/study_folder.hpp"

namespace hypotrack::study {

/// What is in a study's folder.
struct Tally {
  std::size_t planned = 0, ok = 0, failed = 0;
};

/// Writes results.csv (a row per run), cells.csv (a row per cell: mean and standard deviation over
/// the seeds) and timing.csv from whatever runs are there, each file whole or not at all. The first
/// two are the same bytes for the same runs. Throws OutputError or DataError.
HYPOTRACK_API Tally write_tables(const StudyFolder& folder, const Plan& plan);

}  // namespace hypotrack::study
