#include "lab/report/report.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "base/file_bytes.hpp"
#include "base/text_file.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/json_file.hpp"
#include "lab/report/change_data.hpp"
#include "lab/report/page.hpp"
#include "lab/report/report_data.hpp"
#include "lab/report/study_data.hpp"
#include "lab/report/tables/table_data.hpp"

namespace hypotrack::internal {
namespace {

namespace fs = std::filesystem;

/// A temporary folder beside the report, in which the report is made.
class Workshop {
 public:
  explicit Workshop(const fs::path& page)
      : folder_(page.string() + fmt::format(".{}.partial", ::getpid())) {
    std::error_code error;
    fs::create_directories(folder_ / "plots", error);
    if (!error) fs::create_directories(folder_ / "tables", error);
    if (error)
      throw OutputError(fmt::format("{}: cannot be written ({}); name another file with --out",
                                    page.string(), error.message()));
  }
  ~Workshop() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  fs::path operator/(const char* name) const { return folder_ / name; }

 private:
  fs::path folder_;
};

/// Replaces `target` by what was made.
void put_in_place(const fs::path& made, const fs::path& target) {
  std::error_code error;
  if (fs::is_directory(made)) fs::remove_all(target, error);
  if (!error) fs::rename(made, target, error);
  if (error)
    throw OutputError(fmt::format("{}: cannot be written ({}); name another file with --out",
                                  target.string(), error.message()));
}

fs::path page_path(const ReportOptions& options) {
  const fs::path usual =
      options.after.empty() ? options.directory / "report.html" : options.after / "changes.html";
  const fs::path page = options.out.empty() ? usual : options.out;
  if (fs::is_directory(page) || !page.has_filename())
    throw OutputError(fmt::format("{}: is a folder; expected the name of an HTML file after --out",
                                  page.string()));
  if (page.extension() != ".html")
    throw OutputError(fmt::format(
        "{}: does not end in .html; expected the name of an HTML file after --out (a folder of the "
        "same name without .html holds its plots and tables)",
        page.string()));
  if (fs::exists(page) && !fs::is_regular_file(page))
    throw OutputError(fmt::format("{}: {}; expected the name of an HTML file after --out",
                                  page.string(), why_no_file(page)));
  return page;
}

/// Makes the page and the files of one study or run.
void make_report(const StudyData& study, const ReportOptions& options, PluginLoader& plugins,
                 const Workshop& workshop, ReportSummary& summary) {
  const ReportData data = report_data(study, options.replays, plugins);
  TextFile(workshop / "report.html").write(report_page(data.page));
  if (study.is_study)
    write_table_files(study, data.tables, data.page["plots"], workshop / "tables");
  if (options.plot_files != PlotFiles::none)
    summary.skipped = write_plot_files(data.page, workshop / "plots");
  if (options.plot_files == PlotFiles::required && !summary.skipped.empty())
    throw OutputError(summary.skipped);
  summary.replays = data.replays;
}

/// Makes the page and the tables of a study before and after a change.
void make_changes(const StudyData& before, const StudyData& after, const Workshop& workshop) {
  const Json page = change_data(before, after);
  TextFile(workshop / "report.html").write(report_page(page));
  write_change_files(page["tables"], workshop / "tables");
}

}  // namespace

ReportSummary write_report(const ReportOptions& options, PluginLoader& plugins) {
  std::vector<StudyData> studies{read_study(options.directory)};
  if (!options.after.empty()) studies.push_back(read_study(options.after));
  ReportSummary summary;
  summary.page = page_path(options);
  summary.files = summary.page;
  summary.files.replace_extension();
  const Workshop workshop(summary.page);
  if (studies.size() == 1)
    make_report(studies[0], options, plugins, workshop, summary);
  else
    make_changes(studies[0], studies[1], workshop);

  summary.bytes = fs::file_size(workshop / "report.html");
  for (const StudyData& study : studies) {
    summary.runs += study.runs.size();
    summary.planned += study.planned;
    summary.failed += static_cast<std::size_t>(
        std::ranges::count_if(study.runs, [](const StudyRun& run) { return run.failed; }));
  }
  std::error_code error;
  fs::create_directories(summary.files, error);
  if (error)
    throw OutputError(
        fmt::format("{}: the folder cannot be made ({}); name another file with --out",
                    summary.files.string(), error.message()));
  for (const char* part : {"plots", "tables"}) put_in_place(workshop / part, summary.files / part);
  put_in_place(workshop / "report.html", summary.page);
  return summary;
}

}  // namespace hypotrack::internal
