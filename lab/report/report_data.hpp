#pragma once

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

}  // namespace internal
}  // namespace hypotrack
