#pragma once

#include <nlohmann/json.hpp>

#include "hypotrack/export.hpp"
#include "hypotrack/plugin.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {

/// Everything that the page shows, as plain data (what report.js reads).
struct ReportData {
  nlohmann::ordered_json page;
  nlohmann::ordered_json tables;  ///< also within `page`; see table_data()
  std::size_t replays = 0;
};

/// Puts a report together with the replays of at most `most_replays` runs. Throws DataError,
/// ConfigError or PluginError.
HYPOTRACK_API ReportData report_data(const StudyData& study, int most_replays,
                                     PluginLoader& plugins);

/// Which runs get a replay: of each cell the run of median error, and of these cells, ranked by
/// error, `most` evenly from the worst to the best. Indices into StudyData::runs, ascending.
HYPOTRACK_API std::vector<std::size_t> runs_to_replay(const StudyData& study, int most);

}  // namespace hypotrack
