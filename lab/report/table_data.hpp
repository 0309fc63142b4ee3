#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "hypotrack/export.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {

/// The tables of a study as plain data for the page: a list of objects
///   {id, title, note, keys: [label, ...],
///    columns: [{key, label, digits}, ...],
///    rows: [{keys: [text, ...], runs, failed,
///            cells: [{mean, sd, n, best, p, same}, ...]}, ...]}
/// one per scene with a row per cell, and, where there are several scenes, one of the mean error
/// with a column per scene. `best` is the best of its column (of its row in the table of scenes),
/// `same` one that the seeds do not separate from it.
HYPOTRACK_API nlohmann::ordered_json table_data(const StudyData& study);

/// Writes DIRECTORY/<id>.csv for every table and runs.csv with a row per run; numbers in full.
/// Throws OutputError.
HYPOTRACK_API void write_table_files(const StudyData& study, const nlohmann::ordered_json& tables,
                                     const std::filesystem::path& directory);

}  // namespace hypotrack
