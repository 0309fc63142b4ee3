#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "lab/report/study_data.hpp"

namespace hypotrack {

/// Returns the tables of a study as plain data for the page: a list of objects
///
///   {id, title, note, keys: [label, ...],
///    columns: [{key, label, digits}, ...],
///    rows: [{keys: [text, ...], runs, failed,
///            cells: [{mean, sd, n, best, p, same}, ...]}, ...]}
///
/// There is one per scene with a row per cell. With several scenes there is one of the mean error
/// with a column per scene. `best` marks the best of its column (of its row in the table of
/// scenes), `same` one that the seeds do not separate from the best.
nlohmann::ordered_json table_data(const StudyData& study);

/// Writes DIRECTORY/<id>.csv for every table and every plot of how searches converge, and runs.csv
/// with a row per run, with all digits. Throws OutputError.
void write_table_files(const StudyData& study, const nlohmann::ordered_json& tables,
                       const nlohmann::ordered_json& plots, const std::filesystem::path& directory);

}  // namespace hypotrack
