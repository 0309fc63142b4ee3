#pragma once

#include <filesystem>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Choice of whether a report comes with files of its plots.
enum class PlotFiles {
  if_possible,  ///< if the programs that draw them are installed
  required,     ///< OutputError if they are not
  none,
};

struct ReportOptions {
  std::filesystem::path directory;   ///< of a study or a run
  std::filesystem::path after = {};  ///< of the study after a change; empty: none
  /// The HTML file; empty: DIRECTORY/report.html, or AFTER/changes.html.
  std::filesystem::path out;
  int replays = 12;  ///< at most
  PlotFiles plot_files = PlotFiles::if_possible;
};

/// The result of write_report().
struct ReportSummary {
  std::filesystem::path page;
  std::filesystem::path files;  ///< folder with plots/ and tables/
  std::uintmax_t bytes = 0;     ///< of the page
  std::size_t runs = 0;
  std::size_t planned = 0;  ///< runs of the complete study
  std::size_t failed = 0;
  std::size_t replays = 0;
  std::string skipped;  ///< why plots have no separate files; empty if they have
};

/// Writes a self-contained HTML file about a study or a run, or about a study before and after a
/// change. Beside it, in a folder of the same
/// name without `.html`, it writes plots/*.svg, plots/*.png and tables/*.csv. Replaces an earlier
/// report when all is complete. Throws DataError, ConfigError, PluginError or OutputError, and then
/// keeps the earlier one.
ReportSummary write_report(const ReportOptions& options, PluginLoader& plugins);

}  // namespace internal
}  // namespace hypotrack
