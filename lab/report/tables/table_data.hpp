#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/report/study_data.hpp"
#include "lab/report/tables/cells.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the tables of a study as plain data for the page: a list of objects
///
///   {id, title, note, identical, keys: [label, ...],
///    columns: [{key, label, digits}, ...],
///    rows: [{keys: [text, ...], runs, samples, failed,
///            cells: [{mean, sd, n, best, p, same, seeds_needed}, ...]}, ...]}
///
/// There is one per scene with a row per cell. With several scenes there is one of the mean error
/// with a column per scene; its cells have a `detail`, what they cost. `best` marks the best of its
/// column, `same` one that the seeds do not separate from the best. `samples` counts the runs whose
/// results differ, of which `identical` tells the others.
nlohmann::ordered_json table_data(const StudyData& study);

/// Writes DIRECTORY/<id>.csv for every table and every plot of how searches converge, and runs.csv
/// with a row per run, with all digits. Throws OutputError.
void write_table_files(const StudyData& study, const nlohmann::ordered_json& tables,
                       const nlohmann::ordered_json& plots, const std::filesystem::path& directory);

}  // namespace internal
inline namespace HYPOTRACK_EXPORTED internal {

/// Explains the marks of a table whose rows are compared within each column, `comparisons` of them.
/// Warns if the seeds are too few to separate anything.
std::string note_on_tests(const std::vector<StudyCell>& cells, std::size_t comparisons);

/// Names the cells with runs that are the same bit by bit and count as one. Empty if none has.
std::string note_on_identical_runs(const std::vector<StudyCell>& cells);

}  // namespace internal
}  // namespace hypotrack
