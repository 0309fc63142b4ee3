#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/report/cells.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Explains the marks of a table whose rows are compared within each column, `comparisons` of them.
/// Warns if the seeds are too few to separate anything.
std::string note_on_tests(const std::vector<StudyCell>& cells, std::size_t comparisons);

/// Names the cells with runs that are the same bit by bit and count as one. Empty if none has.
std::string note_on_identical_runs(const std::vector<StudyCell>& cells);

}  // namespace internal
}  // namespace hypotrack
