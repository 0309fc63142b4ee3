#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "lab/report/statistics/power.hpp"
#include "lab/report/statistics/significance.hpp"
#include "lab/report/tables/table_data.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kMostNamed = 4;

const char* plural(std::size_t count) { return count == 1 ? "" : "s"; }

}  // namespace

std::string note_on_tests(const std::vector<StudyCell>& cells, std::size_t comparisons) {
  std::size_t seeds = 0;
  for (const StudyCell& cell : cells) seeds = std::max(seeds, distinct_runs(cell.runs).size());
  if (comparisons == 0 || seeds == 0) return "";
  std::string note = fmt::format(
      "Mean ± standard deviation over seeds. Best of a column in bold. ≈: not separated from the "
      "best by {} seed{} (p ≥ {}; Wilcoxon signed-rank test over equal seeds, Mann–Whitney test "
      "otherwise, Holm correction for {} comparison{}). A number after ≈ says how many seeds would "
      "find the difference seen with a power of 80 % (Guenther 1981 for normal differences, "
      "efficiency of ranks 3/π).",
      seeds, plural(seeds), kSignificant, comparisons, plural(comparisons));
  const double smallest =
      std::min(1.0, static_cast<double>(comparisons) * smallest_signed_rank_p(int(seeds)));
  if (smallest >= kSignificant)
    note += fmt::format(
        " So few seeds can separate nothing here: even the clearest difference would have "
        "p = {:.2g}; at least {} seeds are needed.",
        smallest, fewest_pairs(kSignificant / static_cast<double>(comparisons)));
  return note;
}

std::string note_on_identical_runs(const std::vector<StudyCell>& cells) {
  std::vector<std::string> named;
  for (const StudyCell& cell : cells) {
    const std::size_t distinct = distinct_runs(cell.runs).size();
    if (distinct == cell.runs.size()) continue;
    named.push_back(fmt::format("{}{}{} runs, {} sample{}", fmt::join(cell.settings, ", "),
                                cell.settings.empty() ? "" : ": ", cell.runs.size(), distinct,
                                plural(distinct)));
  }
  if (named.empty()) return "";
  const std::size_t more = named.size() - std::min(named.size(), kMostNamed);
  named.resize(named.size() - more);
  return fmt::format(
      "Runs whose results are the same bit by bit count as one sample, as a search without chance "
      "gives them on one recording ({}{}).",
      fmt::join(named, "; "), more > 0 ? fmt::format("; and {} more", more) : "");
}

}  // namespace hypotrack::internal
