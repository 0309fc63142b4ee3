// The files of a study or a run that reports and comparisons read.

#include <array>

#include "lab/report/plots/plot_data.hpp"
#include "lab/report/report_data.hpp"
#include "lab/report/study_data.hpp"
#include "lab/report/tables/table_data.hpp"
#include "lab/study/results.hpp"
#include "parts.hpp"

namespace hypotrack::fuzz {
namespace {

constexpr std::array<std::string_view, 9> kReportFiles = {
    "study.yaml",          "runs/a/cell.json",    "runs/a/errors.csv",
    "runs/a/failure.json", "runs/a/metrics.json", "runs/a/run.yaml",
    "runs/a/summary.json", "runs/a/timing.json",  "runs/a/track.csv"};

/// Writes data as the page does.
void write(const nlohmann::ordered_json& data) {
  require(!data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).empty(), "written");
}

void show(const StudyData& study) {
  write(table_data(study));
  write(plot_data(study));
}

}  // namespace

HYPOTRACK_FUZZ_TARGET(report, "report") {
  const std::filesystem::path folder = scratch() / "report";
  write_parts(bytes, folder, kReportFiles);
  study::Plan plan;
  plan.runs.push_back({.id = "a"});
  bool read = attempt([&] { show(read_study(folder)); });
  read |= attempt([&] { show(read_study(folder / "runs" / "a")); });
  read |= attempt([&] { write(run_series(folder / "runs" / "a")); });
  read |= attempt([&] { study::read_results(plan, folder / "runs"); });
  if (!read) throw DataError("neither a study nor a run");
}

}  // namespace hypotrack::fuzz
