#include <fmt/format.h>

#include <memory>
#include <string>

#include "commands.hpp"
#include "lab/report/report.hpp"
#include "messages.hpp"

namespace hypotrack::app {
namespace {

struct ReportCommand {
  ReportOptions report;
  bool images = false;
  bool no_images = false;
};

/// Returns the number of runs: `2 runs`, or `1 of 2 runs` of an unfinished study.
std::string runs_of(const ReportSummary& summary) {
  if (summary.runs < summary.planned)
    return fmt::format("{} of {} runs", summary.runs, summary.planned);
  return fmt::format("{} run{}", summary.runs, summary.runs == 1 ? "" : "s");
}

int report(const ReportCommand& command, const CommonOptions& common) {
  ReportOptions options = command.report;
  if (command.images) options.plot_files = PlotFiles::required;
  if (command.no_images) options.plot_files = PlotFiles::none;
  PluginLoader plugins(common.plugin_path);
  const ReportSummary summary = write_report(options, plugins);
  if (!summary.skipped.empty()) tell("hypotrack: {}\n", summary.skipped);
  fmt::print("{} ({} failed), {} with a 3D replay, {:.1f} MB: {}\n", runs_of(summary),
             summary.failed, summary.replays, 1e-6 * static_cast<double>(summary.bytes),
             summary.page.string());
  fmt::print("plots and tables in {}\n", summary.files.string());
  return 0;
}

}  // namespace

void add_report_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<ReportCommand>();
  const Command command = root.add_command("report", "Write one HTML file about a study or a run");
  command.add("directory", &options->report.directory, "Folder of a study or of a run",
              {.required = true});
  command.add("after", &options->report.after,
              "Folder of the same study after a change: one page compares both, cell by cell");
  command.add("--out", &options->report.out,
              "HTML file [DIRECTORY/report.html, AFTER/changes.html]; a folder of the same name "
              "without .html gets "
              "plots and tables",
              {.check = file_name()});
  command.add("--replays", &options->report.replays, "Runs with a 3D replay, at most",
              {.show_default = true, .check = whole_number(0)});
  command.add("--images", &options->images,
              "Fail if the plots cannot have files of their own (SVG, PNG), which need nodejs and "
              "rsvg-convert");
  command.add("--no-images", &options->no_images, "Leave the files of the plots out",
              {.excludes = "--images"});
  command.on_call([=, &common, &exit_code] { exit_code = report(*options, common); });
}

}  // namespace hypotrack::app
