#include "lab/study/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/csv.hpp"
#include "base/statistics.hpp"
#include "base/text_file.hpp"
#include "lab/json_file.hpp"
#include "lab/run_numbers.hpp"
#include "lab/study/run_folder.hpp"

namespace hypotrack::study::internal {
namespace {

constexpr std::array<std::string_view, 3> kTimed = {"fps", "search_fps", "evaluations_per_second"};

bool is_timed(const std::string& name) {
  return std::find(kTimed.begin(), kTimed.end(), name) != kTimed.end();
}

/// Reads the numbers at the top level of a file. `null` is an undefined number.
Metrics read_metrics(const std::filesystem::path& file) {
  Metrics metrics;
  const std::string advice = repair_advice(file);
  const Json json = read_json_object(file, advice);
  check_numbers(json, file, advice);
  for (const auto& [name, value] : json.items()) {
    if (value.is_number()) metrics.emplace_back(name, value.get<double>());
    if (value.is_null()) metrics.emplace_back(name, std::nullopt);
  }
  return metrics;
}

RunResult read_result(const PlannedRun& run, const std::filesystem::path& folder) {
  RunResult result;
  result.run = &run;
  if (const auto failure = read_failure(folder)) {
    result.ok = false;
    result.message = failure->message;
    return result;
  }
  result.timing = read_metrics(folder / "timing.json");
  // Without ground truth there are no metrics: compare the numbers of the summary instead.
  Metrics summary = read_metrics(folder / "summary.json");
  for (const auto& entry : summary)
    if (is_timed(entry.first)) result.timing.push_back(entry);
  std::erase_if(summary, [](const auto& entry) { return is_timed(entry.first); });
  result.metrics =
      expects_metrics(folder) ? read_metrics(folder / "metrics.json") : std::move(summary);
  return result;
}

using Column = Metrics RunResult::*;

std::string csv(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "";
}

std::string csv_known(double number) { return std::isnan(number) ? "" : fmt::format("{}", number); }

std::string header_of(const Plan& plan) {
  std::string text = "scene";
  for (const Axis& axis : plan.study.axes) text += "," + csv_cell(axis.name);
  return text;
}

std::string row_of(const Plan& plan, const Cell& cell) {
  std::string text = plan.scene_of(cell).name;
  for (std::size_t axis = 0; axis < plan.study.axes.size(); ++axis)
    text += "," + csv_cell(plan.choice_of(cell, axis).label);
  return text;
}

/// Returns the names of all numbers that any run has, in the order in which they first appear.
std::vector<std::string> names_of(const std::vector<RunResult>& results, Column column) {
  std::vector<std::string> names;
  for (const RunResult& result : results)
    for (const auto& [name, value] : result.*column)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

std::optional<double> find(const Metrics& metrics, const std::string& name) {
  for (const auto& [other, value] : metrics)
    if (other == name) return value;
  return std::nullopt;
}

std::string numbers_of(const Metrics& metrics, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += "," + csv(find(metrics, name));
  return text;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += "," + csv_cell(name);
  return text;
}

std::string results_text(const Plan& plan, const std::vector<RunResult>& results) {
  const auto names = names_of(results, &RunResult::metrics);
  std::string text = header_of(plan) + ",seed,status,message" + joined(names) + "\n";
  for (const RunResult& result : results)
    text += fmt::format("{},{},{},{}{}\n", row_of(plan, plan.cells[result.run->cell]),
                        result.run->seed, result.ok ? "ok" : "failed", csv_cell(result.message),
                        numbers_of(result.metrics, names));
  return text;
}

std::string timing_text(const Plan& plan, const std::vector<RunResult>& results) {
  const std::vector<std::string> names = {"fps",     "search_fps", "evaluations_per_second",
                                          "seconds", "threads",    "gpu"};
  std::string text = header_of(plan) + ",seed" + joined(names) + "\n";
  for (const RunResult& result : results)
    if (result.ok)
      text += fmt::format("{},{}{}\n", row_of(plan, plan.cells[result.run->cell]), result.run->seed,
                          numbers_of(result.timing, names));
  return text;
}

/// Formats the mean and standard deviation of each number over the runs [begin, end) of one cell.
std::string cell_numbers(const RunResult* begin, const RunResult* end,
                         const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    std::vector<double> values;
    for (const RunResult* result = begin; result != end; ++result)
      if (const auto value = find(result->metrics, name)) values.push_back(*value);
    text += "," + csv_known(mean(values)) + "," + csv_known(sample_deviation(values));
  }
  return text;
}

std::string cells_text(const Plan& plan, const std::vector<RunResult>& results) {
  const auto names = names_of(results, &RunResult::metrics);
  std::string text = header_of(plan) + ",runs,failed";
  for (const std::string& name : names) text += fmt::format(",{0}_mean,{0}_sd", csv_cell(name));
  text += "\n";
  const RunResult* const all_end = results.data() + results.size();
  for (const RunResult* begin = results.data(); begin != all_end;) {
    const std::size_t cell = begin->run->cell;
    const auto* const end =
        std::find_if(begin, all_end, [&](const RunResult& r) { return r.run->cell != cell; });
    const auto failed = std::count_if(begin, end, [](const RunResult& r) { return !r.ok; });
    text += fmt::format("{},{},{}{}\n", row_of(plan, plan.cells[cell]), end - begin, failed,
                        cell_numbers(begin, end, names));
    begin = end;
  }
  return text;
}

Tally tally_of(const Plan& plan, const std::vector<RunResult>& results) {
  Tally tally;
  tally.planned = plan.runs.size();
  for (const RunResult& result : results) ++(result.ok ? tally.ok : tally.failed);
  return tally;
}

}  // namespace

std::vector<RunResult> read_results(const Plan& plan, const std::filesystem::path& runs) {
  std::vector<std::size_t> order(plan.runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return plan.runs[a].cell < plan.runs[b].cell;
  });
  std::vector<RunResult> results;
  for (const std::size_t index : order) {
    const PlannedRun& run = plan.runs[index];
    const std::filesystem::path folder = runs / run.id;
    if (std::filesystem::exists(folder)) results.push_back(read_result(run, folder));
  }
  return results;
}

Tally write_tables(const StudyFolder& folder, const Plan& plan) {
  // Under the lock, the last process that writes sees the runs of all others.
  const FileLock lock = folder.lock();
  const std::vector<RunResult> results = read_results(plan, folder.path() / "runs");
  write_whole(folder.path() / "results.csv", results_text(plan, results));
  write_whole(folder.path() / "cells.csv", cells_text(plan, results));
  write_whole(folder.path() / "timing.csv", timing_text(plan, results));
  return tally_of(plan, results);
}

}  // namespace hypotrack::study::internal
