#pragma once

#include <filesystem>
#include <string>

#include "hypotrack/export.hpp"
#include "hypotrack/plugin.hpp"

namespace hypotrack {

/// Whether a report comes with files of its plots.
enum class PlotFiles {
  if_possible,  ///< where the programs that draw them are installed
  required,     ///< OutputError where they are not
  none,
};

struct ReportOptions {
  std::filesystem::path directory;  ///< of a study or a run
  std::filesystem::path out;        ///< the HTML file; DIRECTORY/report.html if empty
  int replays = 12;                 ///< at most
  PlotFiles plot_files = PlotFiles::if_possible;
};

/// What came of a report.
struct ReportSummary {
  std::filesystem::path page;
  std::filesystem::path files;  ///< folder with plots/ and tables/
  std::uintmax_t bytes = 0;     ///< of the page
  std::size_t runs = 0;
  std::size_t failed = 0;
  std::size_t replays = 0;
  std::string skipped;  ///< why plots have no files of their own; empty if they have
};

/// Writes one self-contained HTML file about a study or a run, and beside it, in a folder of the
/// same name without `.html`, plots/*.svg, plots/*.png and tables/*.csv. Everything appears when it
/// is complete, in place of an earlier report. Throws DataError, ConfigError, PluginError or
/// OutputError, and then leaves what was there.
HYPOTRACK_API ReportSummary write_report(const ReportOptions& options, PluginLoader& plugins);

}  // namespace hypotrack
