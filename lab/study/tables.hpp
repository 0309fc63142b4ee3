#pragma once

#include <cstddef>

#include "base/exported.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/study_folder.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

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
