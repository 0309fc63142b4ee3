#include "lab/run_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "output/metrics/metrics.hpp"

namespace hypotrack::internal {
namespace {

/// Returns whether a number is known whatever the run was like, if some frame has an error.
bool is_always_known(std::string_view name, bool has_errors) {
  if (name == "frames" || name == "evaluated_frames" || name == "missing_frames" ||
      name == "lost_frames")
    return true;
  return has_errors &&
         (name.ends_with("_error_mm") || name.starts_with("success_") || name.starts_with("auc_"));
}

std::string found_in(const Json& value) {
  if (value.is_string()) return "a text";
  if (value.is_array()) return "a list";
  return value.is_object() ? "a map" : value.dump();
}

}  // namespace

const std::vector<std::string>& run_numbers() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names = metric_names();
    names.insert(names.end(), {"fps", "search_fps", "evaluations_per_second", "seconds", "threads",
                               "mean_sigma_mm"});
    return names;
  }();
  return all;
}

bool expects_metrics(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / "metrics.json") ||
         std::filesystem::exists(folder / "errors.csv");
}

void check_numbers(const Json& json, const std::filesystem::path& file, std::string_view advice) {
  const auto evaluated = json.find("evaluated_frames");
  const bool has_errors =
      evaluated != json.end() && evaluated->is_number() && evaluated->get<double>() > 0;
  for (const auto& [name, value] : json.items()) {
    if (std::ranges::find(run_numbers(), name) == run_numbers().end()) continue;
    if (value.is_null() && !is_always_known(name, has_errors)) continue;
    // Times of frames may descend, and so the time to loss be negative.
    if (value.is_number() && (value.get<double>() >= 0 || name == "time_to_loss_s")) continue;
    throw DataError(fmt::format("{}: '{}' is {}, expected a number of at least 0; {}",
                                file.string(), name, found_in(value), advice));
  }
}

}  // namespace hypotrack::internal
