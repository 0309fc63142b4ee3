#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/exported.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Compares a study before and after a change, cell by cell. Returns the page in this form:
///
///   {kind: "change", title, about, version, left_out, facts: [[name, text], ...],
///    tables: [{id, title, note, keys: [label, ...], columns: [{key, label, digits}, ...],
///              rows: [{keys: [text, ...], before, after,
///                      cells: [{before, after, difference, sd, p, verdict, seeds_needed},
///                              ...]}, ...]}, ...]}
///
/// There is a table per scene. `before` and `after` of a row count samples. `verdict` is "better",
/// "worse", "open" (the seeds do not separate it), "same" or "" where neither end is better.
/// Throws DataError unless both are studies with a cell in common.
nlohmann::ordered_json change_data(const StudyData& before, const StudyData& after);

/// Writes DIRECTORY/<id>.csv for every table of change_data(), with all digits. Throws OutputError.
void write_change_files(const nlohmann::ordered_json& tables,
                        const std::filesystem::path& directory);

}  // namespace internal
}  // namespace hypotrack
