#pragma once

#include <cstddef>
#include <filesystem>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Throws DataError unless a table of a run has one row for each frame that its summary.json
/// counts. Tables without a summary beside them, of other trackers, pass.
void expect_row_per_frame(const std::filesystem::path& table, std::size_t rows);

}  // namespace internal
}  // namespace hypotrack
