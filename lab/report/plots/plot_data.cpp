#include "lab/report/plots/plot_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/statistics.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/json_file.hpp"
#include "lab/report/packed.hpp"
#include "lab/report/plots/plot_parts.hpp"
#include "lab/report/statistics/metric_info.hpp"
#include "lab/report/trace/trace_plots.hpp"

namespace hypotrack::internal {
namespace {

constexpr const char* kMeanError = "mean_error_mm";

/// Adds mean, sd and n to a row. Returns false if there is no finite number.
bool add_statistics(Json& row, const std::vector<double>& numbers) {
  const std::vector<double> finite = without_nan(numbers);
  if (finite.empty()) return false;
  row["mean"] = mean(finite);
  row["sd"] = number_or_null(sample_deviation(finite));
  row["n"] = finite.size();
  return true;
}

/// Makes the rows of one facet.
class Rows {
 public:
  Rows(const StudyData& study, const PlotRequest& request) : study_(study), request_(request) {}

  Json of(const Runs& runs) {
    rows_ = Json::array();
    for_each_value(study_, runs, request_.color, [&](const std::string& color, const Runs& same) {
      Json row;
      if (!request_.color.empty()) row["color"] = value_json(study_, request_.color, color);
      request_.kind == "success" ? add_success(row, same) : add_values(row, same);
    });
    return std::move(rows_);
  }

 private:
  void add_values(const Json& start, const Runs& runs) {
    const bool heatmap = request_.kind == "heatmap";
    const MetricInfo metric = metric_info(heatmap ? request_.value : request_.y);
    for_each_value(study_, runs, request_.x, [&](const std::string& x, const Runs& column) {
      for_each_value(study_, column, heatmap ? request_.y : "",
                     [&](const std::string& y, const Runs& cell) {
                       Json row = start;
                       row["x"] = value_json(study_, request_.x, x);
                       if (heatmap) row["y"] = value_json(study_, request_.y, y);
                       std::vector<double> numbers;
                       for (const StudyRun* run : cell)
                         numbers.push_back(metric.factor * run->number(metric.key));
                       if (add_statistics(row, numbers)) rows_.push_back(std::move(row));
                     });
    });
  }

  void add_success(const Json& start, const Runs& runs) {
    std::map<double, std::vector<double>> shares;
    for (const StudyRun* run : runs)
      for (std::size_t i = 0; i < run->success.share.size(); ++i)
        shares[run->success.threshold_mm[i]].push_back(100 * run->success.share[i]);
    for (const auto& [threshold, numbers] : shares) {
      Json row = start;
      row["x"] = threshold;
      if (add_statistics(row, numbers)) rows_.push_back(std::move(row));
    }
  }

  const StudyData& study_;
  const PlotRequest& request_;
  Json rows_;
};

/// Throws unless `key` is something that the study varies.
void require_axis(const StudyData& study, const PlotRequest& request, const char* role,
                  const std::string& key) {
  if (key == "scene" || key == "seed" || study.axis(key)) return;
  std::string known = "scene, seed";
  for (const StudyAxis& axis : study.axes) known += ", " + axis.key;
  throw DataError(
      fmt::format("study.yaml: a {} plot has {}: '{}', which the study does not vary; expected one "
                  "of: {}",
                  request.kind, role, key, known));
}

void require_metric(const StudyData& study, const PlotRequest& request, const std::string& key) {
  bool measured = false;
  for (const StudyRun& run : study.runs) {
    if (run.metrics.contains(key) || run.timing.contains(key)) return;
    measured = measured || run.metrics.contains(kMeanError);
  }
  if (!measured) return;  // without truth, or if every run failed, the plot is empty and says so
  throw DataError(fmt::format(
      "study.yaml: a {} plot is of '{}', which no run has in its metrics.json; `mean_error_mm` is "
      "what most want",
      request.kind, key));
}

void check(const StudyData& study, const PlotRequest& request) {
  constexpr std::array<std::string_view, 4> kKinds{"curve", "success", "heatmap", "bars"};
  const bool traced = is_traced(request.kind);
  if (!traced && std::find(kKinds.begin(), kKinds.end(), request.kind) == kKinds.end())
    throw DataError(
        fmt::format("study.yaml: '{}' is no kind of plot; expected curve, success, heatmap, bars, "
                    "convergence, targets, performance_profile, data_profile or "
                    "expected_running_time",
                    request.kind));
  const bool heatmap = request.kind == "heatmap";
  if (request.kind != "success" && !traced) {
    require_axis(study, request, "x", request.x);
    require_metric(study, request, heatmap ? request.value : request.y);
  }
  if (heatmap) require_axis(study, request, "y", request.y);
  if (!request.color.empty()) require_axis(study, request, "color", request.color);
  if (!request.facet.empty()) require_axis(study, request, "facet", request.facet);
}

/// Returns the names of what varies but is not shown, and so is averaged over.
std::string averaged_over(const StudyData& study, const PlotRequest& request) {
  std::string names;
  const auto add = [&](const std::string& key) {
    const bool y_is_axis = request.kind == "heatmap" && request.y == key;
    const bool shown =
        request.x == key || request.color == key || request.facet == key || y_is_axis;
    if (!shown && study.values_of(key).size() > 1)
      names += (names.empty() ? "" : ", ") + study.axis_label(key);
  };
  add("scene");
  for (const StudyAxis& axis : study.axes) add(axis.key);
  const bool seeds = request.x != "seed" && request.color != "seed" && request.facet != "seed";
  return names.empty() ? "" : "Averaged over " + names + (seeds ? " as well as seeds." : ".");
}

std::string default_title(const StudyData& study, const PlotRequest& request,
                          const std::string& metric) {
  if (request.kind == "success") return "Share of frames below an error";
  std::string title = fmt::format("{} over {}", metric, study.axis_label(request.x));
  if (request.kind == "heatmap") title += " and " + study.axis_label(request.y);
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

void add_labels(const StudyData& study, const PlotRequest& request, Json& plot) {
  const bool heatmap = request.kind == "heatmap";
  const MetricInfo metric = metric_info(heatmap ? request.value : request.y);
  plot["title"] =
      request.title.empty() ? default_title(study, request, metric.label) : request.title;
  plot["note"] = averaged_over(study, request);
  if (request.kind == "success") {
    plot["x"] = {{"label", request.x_label.empty() ? "error threshold (mm)" : request.x_label}};
    plot["y"] = {{"label", request.y_label.empty() ? "share of frames (%)" : request.y_label}};
    return;
  }
  plot["x"] = dimension(study, request.x, request.x_label);
  plot["value"] = {{"label", metric.label_with_unit()}, {"digits", metric.digits}};
  if (heatmap)
    plot["y"] = dimension(study, request.y, request.y_label);
  else
    plot["y"] = {{"label", request.y_label.empty() ? metric.label_with_unit() : request.y_label}};
}

Json one_plot(const StudyData& study, const PlotRequest& request, std::size_t index) {
  check(study, request);
  Json plot{{"id", fmt::format("plot-{}-{}", index + 1, request.kind)}, {"kind", request.kind}};
  Runs finished;
  for (const StudyRun& run : study.runs)
    if (!run.failed) finished.push_back(&run);
  if (is_traced(request.kind)) {
    plot.update(traced_plot(study, request, finished));
    return plot;
  }
  add_labels(study, request, plot);
  plot["color"] = dimension(study, request.color, "");
  plot["facets"] = Json::array();
  Rows rows(study, request);
  for_each_value(study, finished, request.facet, [&](const std::string& facet, const Runs& runs) {
    plot["facets"].push_back(
        {{"label", facet_label(study, request.facet, facet)}, {"rows", rows.of(runs)}});
  });
  return plot;
}

}  // namespace

std::vector<PlotRequest> default_plots(const StudyData& study) {
  std::vector<const StudyAxis*> varied;
  for (const StudyAxis& axis : study.axes)
    if (axis.values.size() > 1) varied.push_back(&axis);
  const std::string metric = kMeanError;
  const std::string facet = study.scenes.size() > 1 ? "scene" : "";
  const std::string first = varied.empty() ? "" : varied[0]->key;
  const std::string second = varied.size() < 2 ? "" : varied[1]->key;
  std::vector<PlotRequest> plots;
  const auto add = [&](const char* kind, const std::string& x, const std::string& color) {
    plots.push_back({.kind = kind, .x = x, .y = metric, .color = color, .facet = facet});
  };
  if (varied.empty())
    plots.push_back({.kind = "bars", .x = "scene", .y = metric});
  else
    add(varied[0]->numeric ? "curve" : "bars", first, second);
  if (varied.size() > 1) {
    add("heatmap", first, "");
    plots.back().y = second;
    plots.back().value = metric;
  }
  add("success", "", first);
  if (std::ranges::any_of(study.runs, has_trace)) {
    plots.push_back({.kind = "convergence", .color = first, .facet = facet});
    for (const char* kind :
         {"targets", "performance_profile", "data_profile", "expected_running_time"})
      plots.push_back({.kind = kind, .color = first});
  }
  return plots;
}

Json plot_data(const StudyData& study) {
  Json plots = Json::array();
  if (!study.is_study) return plots;
  const std::vector<PlotRequest> requests =
      study.plots.empty() ? default_plots(study) : study.plots;
  for (std::size_t i = 0; i < requests.size(); ++i)
    plots.push_back(one_plot(study, requests[i], i));
  return plots;
}

}  // namespace hypotrack::internal
