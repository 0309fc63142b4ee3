#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the frame-by-frame numbers of a run folder for the page:
///
///   {count, frames: [...] (absent: 0, 1, 2, ...), time, error, models: {NAME: error, ...},
///    cost, milliseconds, status: "ttul...", evaluations: mean per frame, truth_cost,
///    outcome: "ffso-..."}
///
/// Numbers are as pack_numbers() writes them: errors in mm, time in s. Status is the first letter
/// of tracked, uncertain, lost, absent, missing; an outcome that of found, search_failed,
/// objective_failed, or - if unknown. Errors are absent where no truth is known. Runs without a
/// trace or a true state have no truth_cost and no outcome. Throws DataError on damaged tables.
nlohmann::ordered_json run_series(const std::filesystem::path& directory);

}  // namespace internal
}  // namespace hypotrack
