#include <fmt/format.h>

#include <string_view>

#include "base/csv.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/json_file.hpp"
#include "lab/report/study_data.hpp"
#include "lab/run_numbers.hpp"
#include "lab/study/hash.hpp"
#include "lab/study/run_folder.hpp"
#include "output/evaluate/evaluation.hpp"

namespace hypotrack::internal {
namespace {

namespace fs = std::filesystem;

std::vector<double> numbers_in(const Json& list, const fs::path& file) {
  std::vector<double> numbers;
  for (const Json& item : list) {
    if (!item.is_number())
      throw DataError(fmt::format("{}: the success curve holds a {}, expected numbers; {}",
                                  file.string(), item.type_name(), kRepeatRun));
    numbers.push_back(item.get<double>());
  }
  return numbers;
}

void read_success(const Json& json, const fs::path& file, SuccessCurve& curve) {
  if (!json.is_object()) return;
  curve.threshold_mm = numbers_in(json.value("threshold_mm", Json::array()), file);
  curve.share = numbers_in(json.value("share", Json::array()), file);
  if (curve.threshold_mm.size() != curve.share.size())
    throw DataError(fmt::format("{}: the success curve has {} thresholds and {} shares; {}",
                                file.string(), curve.threshold_mm.size(), curve.share.size(),
                                kRepeatRun));
}

void read_metrics(const fs::path& file, StudyRun& run) {
  const Json json = read_json_object(file);
  check_numbers(json, file, kRepeatRun);
  for (const auto& [key, value] : json.items())
    if (value.is_number() || value.is_null()) run.metrics[key] = number_in(json, key.c_str(), file);
  const Json models = json.value("models", Json::object());
  for (const auto& [name, value] : models.items())
    run.models_mm[name] = number_in(models, name.c_str(), file);
  const Json landmarks = json.value("landmarks", Json::object());
  for (const auto& [name, value] : landmarks.items())
    run.landmarks_mm.emplace_back(name, number_in(landmarks, name.c_str(), file));
  read_success(json.value("success_curve", Json::object()), file, run.success);
}

/// Reads from track.csv what the run evaluated, and what tells its result from others.
void read_track(const fs::path& file, StudyRun& run) {
  const CsvTable table(file);
  expect_row_per_frame(file, table.rows().size());
  study::Hash hash;
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    const std::string_view name = table.columns()[c];
    if (name == "milliseconds" || name == "stamp") continue;  // no results
    hash.add(table.columns()[c]);
    for (const CsvTable::Row& row : table.rows()) hash.add(row.cells[c]);
  }
  run.result = hash.value();
  const int column = table.find("evaluations");
  if (column < 0 || table.rows().empty()) return;
  double sum = 0;
  for (const CsvTable::Row& row : table.rows()) sum += table.number(row, column, true);
  run.metrics["evaluations_per_frame"] = sum / static_cast<double>(table.rows().size());
}

std::string setting_text(const Json& value) {
  return canonical_value(value.is_string() ? value.get<std::string>() : value.dump());
}

}  // namespace

void read_results(const fs::path& directory, StudyRun& run) {
  run.directory = directory;
  if (const fs::path file = directory / "failure.json"; fs::exists(file)) {
    run.failed = true;
    run.message = text_in(read_json_object(file), "message", file);
    return;
  }
  if (expects_metrics(directory)) read_metrics(directory / "metrics.json", run);
  const fs::path summary = directory / "summary.json";
  const Json json = read_json_object(summary);
  for (const char* key : {"fps", "evaluations_per_second"})
    run.timing[key] = number_in(json, key, summary);
  if (json.contains("backend")) run.backend = text_in(json, "backend", summary);
  if (run.timing["fps"] > 0) run.timing["frame_seconds"] = 1 / run.timing["fps"];
  if (json.contains("search_fps"))
    run.timing["search_fps"] = number_in(json, "search_fps", summary);
  for (const char* key : {"frames", "lost_frames", "uncertain_frames", "missing_frames"})
    if (!run.metrics.contains(key) && json.contains(key))
      run.metrics[key] = number_in(json, key, summary);
  if (const fs::path file = directory / "track.csv"; fs::exists(file)) read_track(file, run);
}

StudyRun read_study_run(const fs::path& directory) {
  const fs::path file = directory / "cell.json";
  const Json cell = read_json_object(file, study::repair_advice(file));
  StudyRun run;
  run.id = directory.filename().string();
  run.scene = text_in(cell, "scene", file);
  run.seed = integer_in(cell, "seed", file);
  const Json settings = cell.value("settings", Json::object());
  for (const auto& [key, value] : settings.items()) run.settings[key] = setting_text(value);
  read_results(directory, run);
  return run;
}

}  // namespace hypotrack::internal
