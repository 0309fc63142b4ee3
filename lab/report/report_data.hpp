#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/exported.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Everything that the page shows, as plain data for report.js.
struct ReportData {
  nlohmann::ordered_json page;
  nlohmann::ordered_json tables;  ///< also within `page`; see table_data()
  std::size_t replays = 0;
};

/// Makes the data of a report, with the replays of at most `most_replays` runs. Throws DataError,
/// ConfigError or PluginError.
ReportData report_data(const StudyData& study, int most_replays, PluginLoader& plugins);

/// Chooses the runs that get a replay. Takes the run of median error of each cell, ranks them by
/// error, and takes `most` evenly from the worst to the best. Returns ascending indices into
/// StudyData::runs.
std::vector<std::size_t> runs_to_replay(const StudyData& study, int most);

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

/// Limits on a run's pictures in the page.
struct PictureLimits {
  int count = 3;
  int longest_side = 640;  ///< pixels; larger pictures are scaled down
  int quality = 80;        ///< of the JPEG, 0 to 100
};

/// Returns the pictures worst_<frame>.jpg of a run folder, by frame: [{frame, src:
/// "data:image/jpeg..."}]. Throws DataError on a file that is no picture.
nlohmann::ordered_json worst_frames(const std::filesystem::path& run, const PictureLimits& limits);

}  // namespace internal
}  // namespace hypotrack
