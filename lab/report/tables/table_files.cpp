#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "base/csv.hpp"
#include "base/text_file.hpp"
#include "lab/json_file.hpp"
#include "lab/report/tables/table_data.hpp"
#include "lab/report/trace/trace_plots.hpp"

namespace hypotrack::internal {
namespace {

std::string cell(const Json& value) {
  if (value.is_null()) return "";
  return csv_cell(value.is_string() ? value.get<std::string>() : value.dump());
}

/// Leaves out speed: it differs between runs of the same study, and tables should not.
bool is_repeatable(const Json& column) {
  return column["key"] != "fps" && column["key"] != "frame_seconds";
}

std::string table_csv(const Json& table) {
  const Json& columns = table["columns"];
  std::string text;
  for (const Json& key : table["keys"]) text += cell(key) + ",";
  text += "runs,samples,failed";
  for (const Json& column : columns) {
    if (!is_repeatable(column)) continue;
    const std::string key = column["key"];
    for (const char* suffix : {"mean", "sd", "p_against_best", "best", "seeds_needed"})
      text += "," + csv_cell(fmt::format("{}_{}", key, suffix));
  }
  text += "\n";
  for (const Json& row : table["rows"]) {
    for (const Json& key : row["keys"]) text += cell(key) + ",";
    text += cell(row["runs"]) + "," + cell(row["samples"]) + "," + cell(row["failed"]);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (!is_repeatable(columns[i])) continue;
      const Json& entry = row["cells"][i];
      text +=
          fmt::format(",{},{},{},{},{}", cell(entry["mean"]), cell(entry["sd"]), cell(entry["p"]),
                      entry["best"].get<bool>() ? 1 : 0, cell(entry["seeds_needed"]));
    }
    text += "\n";
  }
  return text;
}

/// Returns the lines of a plot of how searches converge as a table.
std::string plot_csv(const Json& plot) {
  const std::string color = plot["color"].is_null() ? "" : cell(plot["color"]["label"]);
  std::string text =
      fmt::format("panel,{}{}x,value,lower,upper,n\n", color, color.empty() ? "" : ",");
  for (const Json& facet : plot["facets"])
    for (const Json& row : facet["rows"]) {
      text += cell(facet["label"]) + ",";
      if (!color.empty()) text += cell(row["color"]) + ",";
      text +=
          fmt::format("{},{},{},{},{}\n", cell(row["x"]), cell(row["mean"]),
                      cell(row.value("lo", Json())), cell(row.value("hi", Json())), cell(row["n"]));
    }
  return text;
}

std::string runs_csv(const StudyData& study) {
  std::vector<std::string> metrics;
  for (const StudyRun& run : study.runs)
    if (run.metrics.size() > metrics.size()) {
      metrics.clear();
      for (const auto& [key, value] : run.metrics) metrics.push_back(key);
    }
  std::string text = "run,scene,";
  for (const StudyAxis& axis : study.axes) text += csv_cell(axis.key) + ",";
  text += "seed,status,message";
  for (const std::string& metric : metrics) text += "," + csv_cell(metric);
  text += "\n";
  for (const StudyRun& run : study.runs) {
    text += csv_cell(run.id) + "," + csv_cell(run.scene) + ",";
    for (const StudyAxis& axis : study.axes) text += csv_cell(run.on_axis(axis.key)) + ",";
    text += fmt::format("{},{},{}", run.seed, run.failed ? "failed" : "ok", csv_cell(run.message));
    for (const std::string& metric : metrics) {
      const double value = run.number(metric);
      text += std::isfinite(value) ? fmt::format(",{}", value) : ",";
    }
    text += "\n";
  }
  return text;
}

}  // namespace

void write_table_files(const StudyData& study, const Json& tables, const Json& plots,
                       const std::filesystem::path& directory) {
  for (const Json& plot : plots)
    if (is_traced(plot["kind"].get<std::string>()))
      TextFile(directory / (plot["id"].get<std::string>() + ".csv")).write(plot_csv(plot));
  for (const Json& table : tables)
    TextFile(directory / (table["id"].get<std::string>() + ".csv")).write(table_csv(table));
  TextFile(directory / "runs.csv").write(runs_csv(study));
}

}  // namespace hypotrack::internal
