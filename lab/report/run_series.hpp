#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// What a run folder says frame by frame, for the page:
///   {count, frames: [...] (absent: 0, 1, 2, ...), time, error, models: {NAME: error, ...},
///    cost, milliseconds, status: "ttul...", evaluations: mean per frame}
/// with numbers as pack_numbers() writes them: errors in mm, time in s; status is the first letter
/// of tracked, uncertain, lost, absent, missing. Errors are absent where no truth is known. Throws
/// DataError on damaged tables.
HYPOTRACK_API nlohmann::ordered_json run_series(const std::filesystem::path& directory);

}  // namespace hypotrack
