#pragma once

#include <cstddef>
#include <filesystem>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Throws DataError unless a table of a run has one row for each frame that its summary.json
/// counts. Tables without a summary beside them, of other trackers, pass.
HYPOTRACK_API void expect_row_per_frame(const std::filesystem::path& table, std::size_t rows);

}  // namespace hypotrack
