#pragma once

#include <optional>
#include <string_view>

#include "base/csv.hpp"
#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The part of a tracker to which a wrong frame is due.
enum class FrameOutcome {
  unknown,           ///< no error or no cost at the truth
  found,             ///< the error is below kFoundErrorMm, whatever the costs
  search_failed,     ///< a wrong pose, and the truth is cheaper: the search missed it
  objective_failed,  ///< a wrong pose, and the truth is not cheaper: no search could tell
};
std::string_view to_string(FrameOutcome outcome);
/// Returns the outcome that to_string() names so; nothing for other texts.
std::optional<FrameOutcome> outcome_named(std::string_view text);
/// Returns the outcome in a cell of truth_costs.csv. Throws DataError on other words.
FrameOutcome outcome_in(const CsvTable& table, const CsvTable::Row& row, int column);

/// The error below which a frame counts as found, in millimetres: that of `success_20mm`.
inline constexpr double kFoundErrorMm = 20;

/// Judges a frame by its error and by the costs of its answer and of the truth in the same
/// pictures. NaN: unknown. Without an answer the cost is infinite, and the search failed whatever
/// the truth costs.
FrameOutcome outcome_of(double error_mm, double cost, double truth_cost);

/// Counts the outcomes of frames.
class OutcomeCounts {
 public:
  void add(FrameOutcome outcome);
  /// Returns the share of an outcome among the frames with a known one; NaN without any.
  double share(FrameOutcome outcome) const;

 private:
  int counts_[4] = {};
};

}  // namespace internal
}  // namespace hypotrack
