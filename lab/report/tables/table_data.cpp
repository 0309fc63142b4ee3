#include "lab/report/tables/table_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "base/statistics.hpp"
#include "lab/json_file.hpp"
#include "lab/report/packed.hpp"
#include "lab/report/tables/cells.hpp"

namespace hypotrack::internal {
namespace {

Json to_json(const Comparison& c) {
  return {{"mean", number_or_null(c.mean)},
          {"sd", number_or_null(c.sd)},
          {"n", c.count},
          {"best", c.best},
          {"p", c.p ? Json(*c.p) : Json()},
          {"same", c.p && *c.p >= kSignificant},
          {"seeds_needed", c.seeds_needed ? Json(*c.seeds_needed) : Json()}};
}

Json column_json(const MetricInfo& metric) {
  return {{"key", metric.key}, {"label", metric.label_with_unit()}, {"digits", metric.digits}};
}

/// Returns the columns for which any run has a number. Lost frames are counted where no truth says
/// their share.
std::vector<MetricInfo> columns_of(const StudyData& study) {
  const auto measured = [&](const std::string& key) {
    return std::any_of(study.runs.begin(), study.runs.end(),
                       [&](const StudyRun& run) { return std::isfinite(run.number(key)); });
  };
  std::vector<MetricInfo> columns;
  for (const std::string& key : table_metrics()) {
    if (key == "lost_frames" && measured("lost_share")) continue;
    if (measured(key)) columns.push_back(metric_info(key));
  }
  return columns;
}

Json key_labels(const StudyData& study) {
  Json labels = Json::array();
  for (const StudyAxis& axis : study.axes) labels.push_back(axis.label);
  return labels;
}

Json row_json(const StudyCell& cell) {
  Json row{{"keys", cell.settings}, {"runs", 0}, {"samples", 0}, {"failed", 0}};
  row["cells"] = Json::array();
  return row;
}

void add_counts(Json& row, const StudyCell& cell) {
  const auto add = [&](const char* key, std::size_t count) {
    row[key] = row[key].get<std::size_t>() + count;
  };
  add("runs", cell.runs.size());
  add("samples", distinct_runs(cell.runs).size());
  add("failed", static_cast<std::size_t>(cell.failed));
}

/// Adds a cell to every row: a metric of the row's runs, compared with the other rows.
void add_column(Json& table, const std::vector<StudyCell>& rows, const MetricInfo& metric) {
  std::vector<Sample> samples;
  for (const StudyCell& cell : rows) samples.push_back(sample_of(cell.runs, metric));
  const std::vector<Comparison> compared = compare_samples(samples, metric.better);
  for (std::size_t i = 0; i < rows.size(); ++i)
    table["rows"][i]["cells"].push_back(to_json(compared[i]));
}

/// Returns a scene's name in a form for file names.
std::string file_name_of(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  return name;
}

/// Names the table of one value of the axis that has a table for each.
void name_part(const StudyData& study, const std::string& part, Json& table) {
  if (part.empty()) return;
  table["id"] = table["id"].get<std::string>() + "-" + file_name_of(part);
  table["title"] = fmt::format("{}, {} {}", table["title"].get<std::string>(),
                               study.axis_label(study.table_per), part);
}

Json scene_table(const StudyData& study, std::size_t index, const std::string& part) {
  const StudyScene& scene = study.scenes[index];
  const std::vector<StudyCell> cells = cells_of(study, scene.name, part);
  Json table{{"id", fmt::format("table-{}-{}", index + 1, file_name_of(scene.name))},
             {"title", scene.label}};
  name_part(study, part, table);
  table["note"] = note_on_tests(cells, cells.empty() ? 0 : cells.size() - 1);
  table["identical"] = note_on_identical_runs(cells);
  table["keys"] = key_labels(study);
  table["columns"] = Json::array();
  table["rows"] = Json::array();
  for (const StudyCell& cell : cells) {
    table["rows"].push_back(row_json(cell));
    add_counts(table["rows"].back(), cell);
  }
  for (const MetricInfo& metric : columns_of(study)) {
    table["columns"].push_back(column_json(metric));
    add_column(table, cells, metric);
  }
  return table;
}

/// Says what a cell of the table of scenes cost: evaluations, speed and frames lost.
std::string detail_of(const StudyCell& cell) {
  std::string text;
  const auto add = [&](const char* key, const char* unit) {
    const MetricInfo metric = metric_info(key);
    const double value = mean(sample_of(cell.runs, metric).values);
    if (std::isfinite(value))
      text += fmt::format("{}{:.{}f}{}", text.empty() ? "" : " · ", value, metric.digits, unit);
  };
  add("evaluations_per_frame", " evaluations");
  add("fps", " fps");
  add("lost_share", " % lost");
  return text;
}

/// Returns the settings for which more than one scene has a metric, in the order of the runs.
std::vector<std::vector<std::string>> shared_settings(
    const std::vector<std::vector<StudyCell>>& scenes, const MetricInfo& metric) {
  std::vector<std::vector<std::string>> order;
  std::map<std::vector<std::string>, int> count;
  for (const std::vector<StudyCell>& cells : scenes)
    for (const StudyCell& cell : cells) {
      if (std::find(order.begin(), order.end(), cell.settings) == order.end())
        order.push_back(cell.settings);
      count[cell.settings] += sample_of(cell.runs, metric).values.empty() ? 0 : 1;
    }
  std::erase_if(order, [&](const auto& settings) { return count[settings] < 2; });
  return order;
}

/// Makes the table of scenes: a row per setting that more than one scene has, a column per scene.
Json scenes_table(const StudyData& study, const std::string& part) {
  const MetricInfo metric = metric_info("mean_error_mm");
  Json table{{"id", "table-scenes"}, {"title", "Scenes compared: " + metric.label_with_unit()}};
  name_part(study, part, table);
  table["keys"] = key_labels(study);
  table["columns"] = Json::array();
  table["rows"] = Json::array();
  std::vector<std::vector<StudyCell>> scenes;
  for (const StudyScene& scene : study.scenes) scenes.push_back(cells_of(study, scene.name, part));
  const auto settings = shared_settings(scenes, metric);
  for (const auto& shared : settings)
    table["rows"].push_back(row_json({.settings = shared, .runs = {}, .failed = 0}));
  std::vector<StudyCell> shown;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    table["columns"].push_back({{"key", study.scenes[s].name},
                                {"label", study.scenes[s].label},
                                {"digits", metric.digits}});
    std::vector<StudyCell> column;
    for (const auto& shared : settings) {
      const auto same = [&](const StudyCell& cell) { return cell.settings == shared; };
      const auto at = std::find_if(scenes[s].begin(), scenes[s].end(), same);
      column.push_back(at == scenes[s].end() ? StudyCell{} : *at);
    }
    add_column(table, column, metric);
    for (std::size_t i = 0; i < column.size(); ++i) {
      Json& row = table["rows"][i];
      row["cells"].back()["detail"] = detail_of(column[i]);
      add_counts(row, column[i]);
    }
    shown.insert(shown.end(), column.begin(), column.end());
  }
  table["note"] = note_on_tests(shown, settings.empty() ? 0 : settings.size() - 1);
  return table;
}

}  // namespace

Json table_data(const StudyData& study) {
  Json tables = Json::array();
  if (!study.is_study) return tables;
  const auto add = [&](Json table) {
    if (!table["rows"].empty()) tables.push_back(std::move(table));
  };
  std::vector<std::string> parts{""};  // values of a scene with a table each
  if (study.axis(study.table_per)) parts = study.values_of(study.table_per);
  if (study.scenes.size() > 1)
    for (const std::string& part : parts) add(scenes_table(study, part));
  for (std::size_t i = 0; i < study.scenes.size(); ++i)
    for (const std::string& part : parts) add(scene_table(study, i, part));
  return tables;
}

}  // namespace hypotrack::internal
