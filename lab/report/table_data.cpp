#include "lab/report/table_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "lab/json_file.hpp"
#include "lab/report/comparison.hpp"
#include "lab/report/metric_info.hpp"
#include "lab/report/number_json.hpp"
#include "lab/report/significance.hpp"

namespace hypotrack {
namespace {

using Runs = std::vector<const StudyRun*>;

/// The runs that differ in their seed only.
struct Cell {
  std::vector<std::string> settings;  ///< one per axis
  Runs runs;                          ///< finished
  int failed = 0;
};

/// Returns the cells of a scene in the order of the runs. With `value`, only those with this value
/// of the axis that has a table per value.
std::vector<Cell> cells_of(const StudyData& study, const std::string& scene,
                           const std::string& value = {}) {
  std::vector<Cell> cells;
  for (const StudyRun& run : study.runs) {
    if (run.scene != scene) continue;
    if (!value.empty() && run.on_axis(study.table_per) != value) continue;
    std::vector<std::string> settings;
    for (const StudyAxis& axis : study.axes) settings.push_back(run.on_axis(axis.key));
    if (cells.empty() || cells.back().settings != settings)
      cells.push_back({.settings = settings, .runs = {}, .failed = 0});
    if (run.failed)
      ++cells.back().failed;
    else
      cells.back().runs.push_back(&run);
  }
  return cells;
}

Sample sample_of(const Runs& runs, const MetricInfo& metric) {
  Sample sample;
  for (const StudyRun* run : runs) {
    const double value = metric.factor * run->number(metric.key);
    if (!std::isfinite(value)) continue;
    sample.seeds.push_back(run->seed);
    sample.values.push_back(value);
  }
  return sample;
}

Json to_json(const Comparison& c) {
  return {{"mean", number_or_null(c.mean)},
          {"sd", number_or_null(c.sd)},
          {"n", c.count},
          {"best", c.best},
          {"p", c.p ? Json(*c.p) : Json()},
          {"same", c.p && *c.p >= kSignificant}};
}

Json column_json(const MetricInfo& metric) {
  return {{"key", metric.key}, {"label", metric.label_with_unit()}, {"digits", metric.digits}};
}

/// Explains the marks, and warns if the seeds are too few to separate anything.
std::string note_on_tests(std::size_t seeds, std::size_t comparisons, const std::string& among) {
  if (comparisons == 0 || seeds == 0) return "";
  std::string note = fmt::format(
      "Mean ± standard deviation over seeds. Best of {} in bold. ≈: not separated from the best by "
      "{} seed{} (p ≥ {}; Wilcoxon signed-rank test over equal seeds, Mann–Whitney test otherwise, "
      "Holm correction for {} comparison{}).",
      among, seeds, seeds == 1 ? "" : "s", kSignificant, comparisons, comparisons == 1 ? "" : "s");
  const double smallest =
      std::min(1.0, static_cast<double>(comparisons) * smallest_signed_rank_p(int(seeds)));
  if (smallest >= kSignificant)
    note += fmt::format(
        " So few seeds can separate nothing here: even the clearest difference would have "
        "p = {:.2g}.",
        smallest);
  return note;
}

/// Returns the columns for which any run has a number.
std::vector<MetricInfo> columns_of(const StudyData& study) {
  std::vector<MetricInfo> columns;
  for (const std::string& key : table_metrics()) {
    const bool measured =
        std::any_of(study.runs.begin(), study.runs.end(),
                    [&](const StudyRun& run) { return std::isfinite(run.number(key)); });
    if (measured) columns.push_back(metric_info(key));
  }
  return columns;
}

Json key_labels(const StudyData& study) {
  Json labels = Json::array();
  for (const StudyAxis& axis : study.axes) labels.push_back(axis.label);
  return labels;
}

Json row_json(const Cell& cell) {
  return {{"keys", cell.settings},
          {"runs", cell.runs.size()},
          {"failed", cell.failed},
          {"cells", Json::array()}};
}

std::size_t most_seeds(const std::vector<Cell>& cells) {
  std::size_t most = 0;
  for (const Cell& cell : cells) most = std::max(most, cell.runs.size());
  return most;
}

/// Returns a scene's name in a form for file names.
std::string file_name_of(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  return name;
}

Json scene_table(const StudyData& study, std::size_t index, const std::string& value = {}) {
  const StudyScene& scene = study.scenes[index];
  const std::vector<Cell> cells = cells_of(study, scene.name, value);
  const std::vector<MetricInfo> columns = columns_of(study);
  Json table{{"id", fmt::format("table-{}-{}", index + 1, file_name_of(scene.name))},
             {"title", scene.label}};
  if (!value.empty()) {
    table["id"] = table["id"].get<std::string>() + "-" + file_name_of(value);
    table["title"] =
        fmt::format("{}, {} {}", scene.label, study.axis_label(study.table_per), value);
  }
  table["note"] =
      note_on_tests(most_seeds(cells), cells.empty() ? 0 : cells.size() - 1, "a column");
  table["keys"] = key_labels(study);
  table["columns"] = Json::array();
  table["rows"] = Json::array();
  for (const Cell& cell : cells) table["rows"].push_back(row_json(cell));
  for (const MetricInfo& metric : columns) {
    table["columns"].push_back(column_json(metric));
    std::vector<Sample> samples;
    for (const Cell& cell : cells) samples.push_back(sample_of(cell.runs, metric));
    const std::vector<Comparison> compared = compare_samples(samples, metric.better);
    for (std::size_t i = 0; i < cells.size(); ++i)
      table["rows"][i]["cells"].push_back(to_json(compared[i]));
  }
  return table;
}

/// The runs of every scene with the same settings.
struct SharedSettings {
  std::vector<std::string> settings;
  std::vector<Runs> runs;  ///< one per scene
};

/// Returns the settings of all scenes, in the order of the runs.
std::vector<SharedSettings> shared_settings(const StudyData& study) {
  std::vector<SharedSettings> all;
  for (std::size_t s = 0; s < study.scenes.size(); ++s)
    for (const Cell& cell : cells_of(study, study.scenes[s].name)) {
      auto it = std::find_if(all.begin(), all.end(), [&](const SharedSettings& shared) {
        return shared.settings == cell.settings;
      });
      if (it == all.end())
        it = all.insert(
            all.end(), {.settings = cell.settings, .runs = std::vector<Runs>(study.scenes.size())});
      it->runs[s] = cell.runs;
    }
  return all;
}

/// Makes the table of scenes: a row per setting that more than one scene has.
Json scenes_table(const StudyData& study) {
  const MetricInfo metric = metric_info("mean_error_mm");
  Json table{{"id", "table-scenes"}, {"title", "Scenes compared: " + metric.label_with_unit()}};
  table["keys"] = key_labels(study);
  table["columns"] = Json::array();
  for (const StudyScene& scene : study.scenes)
    table["columns"].push_back(
        {{"key", scene.name}, {"label", scene.label}, {"digits", metric.digits}});
  table["rows"] = Json::array();
  std::size_t seeds = 0, comparisons = 0;
  for (const SharedSettings& shared : shared_settings(study)) {
    std::vector<Sample> samples;
    std::size_t runs = 0;
    for (const Runs& of_scene : shared.runs) {
      samples.push_back(sample_of(of_scene, metric));
      runs += of_scene.size();
      seeds = std::max(seeds, of_scene.size());
    }
    const auto filled = std::count_if(samples.begin(), samples.end(),
                                      [](const Sample& s) { return !s.values.empty(); });
    if (filled < 2) continue;
    comparisons = std::max(comparisons, static_cast<std::size_t>(filled) - 1);
    Json row{{"keys", shared.settings}, {"runs", runs}, {"failed", 0}, {"cells", Json::array()}};
    for (const Comparison& c : compare_samples(samples, metric.better))
      row["cells"].push_back(to_json(c));
    table["rows"].push_back(std::move(row));
  }
  table["note"] = note_on_tests(seeds, comparisons, "a row");
  return table;
}

}  // namespace

Json table_data(const StudyData& study) {
  Json tables = Json::array();
  if (!study.is_study) return tables;
  if (study.scenes.size() > 1) {
    Json table = scenes_table(study);
    if (!table["rows"].empty()) tables.push_back(std::move(table));
  }
  std::vector<std::string> parts{""};  // values of a scene with a table each
  if (study.axis(study.table_per)) parts = study.values_of(study.table_per);
  for (std::size_t i = 0; i < study.scenes.size(); ++i)
    for (const std::string& part : parts) {
      Json table = scene_table(study, i, part);
      if (!table["rows"].empty()) tables.push_back(std::move(table));
    }
  return tables;
}

}  // namespace hypotrack
