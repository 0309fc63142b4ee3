#include "output/metrics/frame_outcome.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {

std::string_view to_string(FrameOutcome outcome) {
  switch (outcome) {
    case FrameOutcome::found:
      return "found";
    case FrameOutcome::search_failed:
      return "search_failed";
    case FrameOutcome::objective_failed:
      return "objective_failed";
    case FrameOutcome::unknown:
      break;
  }
  return "";
}

std::optional<FrameOutcome> outcome_named(std::string_view text) {
  for (const FrameOutcome outcome : {FrameOutcome::unknown, FrameOutcome::found,
                                     FrameOutcome::search_failed, FrameOutcome::objective_failed})
    if (to_string(outcome) == text) return outcome;
  return std::nullopt;
}

FrameOutcome outcome_in(const CsvTable& table, const CsvTable::Row& row, int column) {
  const std::string_view text = row.cells[static_cast<std::size_t>(column)];
  if (const auto outcome = outcome_named(text)) return *outcome;
  throw DataError(fmt::format(
      "{}: the outcome is '{}'; expected found, search_failed, objective_failed or nothing",
      table.where(row), text));
}

FrameOutcome outcome_of(double error_mm, double cost, double truth_cost) {
  if (std::isnan(error_mm) || std::isnan(cost)) return FrameOutcome::unknown;
  const bool answers = std::isfinite(cost);
  if (answers && std::isnan(truth_cost)) return FrameOutcome::unknown;
  if (error_mm < kFoundErrorMm) return FrameOutcome::found;
  return !answers || truth_cost < cost ? FrameOutcome::search_failed
                                       : FrameOutcome::objective_failed;
}

void OutcomeCounts::add(FrameOutcome outcome) { ++counts_[static_cast<int>(outcome)]; }

double OutcomeCounts::share(FrameOutcome outcome) const {
  int known = 0;
  for (const FrameOutcome one :
       {FrameOutcome::found, FrameOutcome::search_failed, FrameOutcome::objective_failed})
    known += counts_[static_cast<int>(one)];
  if (known == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(counts_[static_cast<int>(outcome)]) / known;
}

}  // namespace hypotrack::internal
