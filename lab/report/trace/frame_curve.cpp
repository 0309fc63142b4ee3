#include "lab/report/trace/frame_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "base/csv.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Returns how far a cost is above that of the truth, as a share of the latter.
double excess_of(double cost, double truth) {
  const double above = cost - truth;
  return above == 0 ? 0 : above / std::abs(truth);
}

/// The columns of trace.csv that a curve needs.
class Columns {
 public:
  Columns(const CsvTable& table, const std::filesystem::path& file, TraceCost over)
      : table_(table), file_(file) {
    constexpr std::array kNames{"evaluations", "cpu_seconds", "wall_seconds"};
    frame_ = find("frame");
    search_ = find("search");
    dimension_ = find("dimension");
    cost_ = find("cost");
    truth_ = find("truth_cost");
    spent_ = find(kNames[static_cast<std::size_t>(over)]);
  }

  int frame(const CsvTable::Row& row) const { return table_.frame(row, frame_); }
  int search(const CsvTable::Row& row) const { return table_.frame(row, search_); }
  int dimension(const CsvTable::Row& row) const { return table_.frame(row, dimension_); }
  /// Returns the cost; infinite where the cell is empty.
  double cost(const CsvTable::Row& row) const {
    const double cost = table_.number(row, cost_, true);
    return std::isnan(cost) ? kInfinite : cost;
  }
  double truth(const CsvTable::Row& row) const { return table_.number(row, truth_, true); }
  double spent(const CsvTable::Row& row) const { return table_.number(row, spent_, false); }

 private:
  int find(const char* name) const {
    const int column = table_.find(name);
    if (column < 0)
      throw DataError(
          fmt::format("{}: has no column '{}'; repeat the run that wrote it, or remove it",
                      file_.string(), name));
    return column;
  }

  const CsvTable& table_;
  const std::filesystem::path& file_;
  int frame_, search_, dimension_, cost_, truth_, spent_;
};

}  // namespace

const CurveStep* FrameCurve::at(double budget) const {
  const auto after =
      std::ranges::upper_bound(steps, budget, {}, [](const CurveStep& step) { return step.spent; });
  return after == steps.begin() ? nullptr : &*std::prev(after);
}

Trial FrameCurve::towards(double tolerance) const {
  for (const CurveStep& step : steps)
    if (step.excess <= tolerance) return {step.spent, true};
  return {spent, false};
}

std::vector<FrameCurve> read_curves(const std::filesystem::path& file, TraceCost over) {
  const CsvTable table(file);
  const Columns columns(table, file, over);
  std::vector<FrameCurve> curves;
  int search = 0;
  double before = 0;  // spent in earlier searches of the frame
  for (const CsvTable::Row& row : table.rows()) {
    const int frame = columns.frame(row);
    if (curves.empty() || curves.back().frame != frame) {
      curves.push_back({.frame = frame, .dimension = columns.dimension(row)});
      search = columns.search(row);
      before = 0;
    } else if (columns.search(row) != search) {
      search = columns.search(row);
      before = curves.back().spent;
    }
    FrameCurve& curve = curves.back();
    curve.spent = before + columns.spent(row);
    const double cost = columns.cost(row), excess = excess_of(cost, columns.truth(row));
    if (!std::isfinite(cost)) continue;
    if (curve.steps.empty()) {
      curve.steps.push_back({curve.spent, cost, excess});
      continue;
    }
    const CurveStep& best = curve.steps.back();
    if (cost < best.cost || excess < best.excess)
      curve.steps.push_back(
          {curve.spent, std::min(cost, best.cost), std::fmin(excess, best.excess)});
  }
  return curves;
}

}  // namespace hypotrack::internal
