#include "lab/report/report_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "lab/json_file.hpp"
#include "lab/report/packed.hpp"
#include "lab/report/plots/plot_data.hpp"
#include "lab/report/replay.hpp"
#include "lab/report/statistics/metric_info.hpp"
#include "lab/report/tables/table_data.hpp"

namespace hypotrack::internal {
namespace {

constexpr const char* kError = "mean_error_mm";

// Pictures of a run without a replay.
constexpr PictureLimits kFewPictures{.count = 1, .longest_side = 320, .quality = 75};

Json metrics_json(const StudyRun& run) {
  Json metrics = Json::object();
  for (const auto* numbers : {&run.metrics, &run.timing})
    for (const auto& [key, value] : *numbers) metrics[key] = number_or_null(value);
  return metrics;
}

Json run_json(const StudyData& study, const StudyRun& run) {
  Json json{{"id", run.id},
            {"scene", study.value_label("scene", run.scene)},
            {"seed", run.seed},
            {"failed", run.failed},
            {"settings", Json::array()}};
  for (const StudyAxis& axis : study.axes) json["settings"].push_back(run.on_axis(axis.key));
  if (run.failed) {
    json["message"] = run.message;
    return json;
  }
  if (!run.backend.empty()) json["backend"] = run.backend;
  json["metrics"] = metrics_json(run);
  json["models"] = run.models_mm;
  json["landmarks"] = Json::array();
  for (const auto& [name, error] : run.landmarks_mm)
    json["landmarks"].push_back({name, number_or_null(error)});
  if (!run.success.share.empty())
    json["success"] = {{"threshold_mm", run.success.threshold_mm}, {"share", run.success.share}};
  json["series"] = run_series(run.directory);
  return json;
}

/// Returns the presentation of the metrics that any run has.
Json metric_list(const StudyData& study) {
  std::set<std::string> keys;
  for (const StudyRun& run : study.runs)
    for (const auto* numbers : {&run.metrics, &run.timing})
      for (const auto& [key, value] : *numbers) keys.insert(key);
  Json list = Json::object();
  for (const std::string& key : keys) {
    const MetricInfo metric = metric_info(key);
    list[key] = {{"label", metric.label},
                 {"unit", metric.unit},
                 {"factor", metric.factor},
                 {"digits", metric.digits}};
  }
  return list;
}

Json axes_json(const StudyData& study) {
  Json axes = Json::array();
  for (const StudyAxis& axis : study.axes)
    axes.push_back({{"key", axis.key}, {"label", axis.label}});
  return axes;
}

std::string left_out(std::size_t runs, std::size_t replays) {
  if (replays >= runs) return "";
  return fmt::format(
      "To keep this file small, {} of {} runs have a 3D replay (of each setting the run of median "
      "error, evenly from the worst setting to the best; --replays N changes how many), and the "
      "others one small picture.",
      replays, runs);
}

}  // namespace

std::vector<std::size_t> runs_to_replay(const StudyData& study, int most) {
  std::map<std::pair<std::string, std::map<std::string, std::string>>, std::vector<std::size_t>>
      cells;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    const StudyRun& run = study.runs[i];
    if (!run.failed) cells[{run.scene, run.settings}].push_back(i);
  }
  // Unknown errors count as 0, as sorting must not see NaN.
  const auto error = [&](std::size_t i) {
    const double value = study.runs[i].number(kError);
    return std::isfinite(value) ? value : 0;
  };
  const auto worse = [&](std::size_t a, std::size_t b) { return error(a) > error(b); };
  std::vector<std::size_t> medians;
  for (auto& [key, runs] : cells) {
    std::stable_sort(runs.begin(), runs.end(), worse);
    medians.push_back(runs[runs.size() / 2]);
  }
  std::sort(medians.begin(), medians.end());
  std::stable_sort(medians.begin(), medians.end(), worse);
  const std::size_t count = std::min(medians.size(), static_cast<std::size_t>(std::max(most, 0)));
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k)
    chosen.push_back(medians[count == 1 ? 0 : k * (medians.size() - 1) / (count - 1)]);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

ReportData report_data(const StudyData& study, int most_replays, PluginLoader& plugins) {
  ReportData data;
  Json& page = data.page;
  data.tables = table_data(study);
  page = {{"kind", study.is_study ? "study" : "run"},
          {"title", study.title},
          {"about", study.about},
          {"version", HYPOTRACK_VERSION},
          {"planned", study.planned},
          {"axes", axes_json(study)},
          {"metrics", metric_list(study)},
          {"plots", plot_data(study)},
          {"tables", data.tables},
          {"runs", Json::array()}};
  const std::vector<std::size_t> replayed = runs_to_replay(study, most_replays);
  ReplayCollector replays(plugins);
  std::size_t finished = 0;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    const StudyRun& run = study.runs[i];
    Json json = run_json(study, run);
    if (!run.failed) {
      ++finished;
      const bool full = std::binary_search(replayed.begin(), replayed.end(), i);
      if (full) json["replay"] = replays.add(run.directory);
      json["worst"] = worst_frames(run.directory, full ? PictureLimits{} : kFewPictures);
    }
    page["runs"].push_back(std::move(json));
  }
  data.replays = replayed.size();
  page["left_out"] = left_out(finished, data.replays);
  page["shapes"] = replays.shapes();
  page["motions"] = replays.motions();
  return data;
}

}  // namespace hypotrack::internal
