#include "lab/study/results.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>
#include <string>
#include <string_view>

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

}  // namespace hypotrack::study::internal
