#include <fmt/format.h>

#include <limits>
#include <map>

#include "base/csv.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/json_file.hpp"
#include "lab/report/packed.hpp"
#include "lab/report/report_data.hpp"
#include "output/metrics/frame_outcome.hpp"
#include "output/metrics/status_metrics.hpp"

namespace hypotrack::internal {
namespace {

namespace fs = std::filesystem;

int require_column(const CsvTable& table, const char* name, const fs::path& file) {
  const int column = table.find(name);
  if (column < 0)
    throw DataError(
        fmt::format("{}: has no column '{}'; expected a table that `hypotrack run` wrote",
                    file.string(), name));
  return column;
}

std::vector<double> numbers(const CsvTable& table, int column) {
  std::vector<double> values;
  for (const CsvTable::Row& row : table.rows()) values.push_back(table.number(row, column, true));
  return values;
}

std::string status_letters(const CsvTable& table, int column, const fs::path& file) {
  std::string letters;
  for (const CsvTable::Row& row : table.rows()) {
    const std::string_view word = row.cells[static_cast<std::size_t>(column)];
    if (!status_named(word))
      throw DataError(fmt::format(
          "{}: the status is '{}'; expected tracked, uncertain, lost, absent or missing",
          table.where(row), word));
    letters += word.front();
  }
  if (letters.empty())
    throw DataError(fmt::format("{}: has no rows; expected one per frame", file.string()));
  return letters;
}

/// Returns the rows of a table for the given frames; null where it has none.
std::vector<const CsvTable::Row*> rows_of(const CsvTable& table, const std::vector<int>& frames,
                                          const fs::path& file) {
  const int frame_column = require_column(table, "frame", file);
  std::map<int, const CsvTable::Row*> row_of;
  for (const CsvTable::Row& row : table.rows()) row_of[table.frame(row, frame_column)] = &row;
  std::vector<const CsvTable::Row*> rows;
  for (const int frame : frames) {
    const auto it = row_of.find(frame);
    rows.push_back(it == row_of.end() ? nullptr : it->second);
  }
  return rows;
}

/// Packs the numbers of a column; unknown where there is no row.
Json packed(const CsvTable& table, int column, const std::vector<const CsvTable::Row*>& rows) {
  std::vector<double> values;
  for (const CsvTable::Row* row : rows)
    values.push_back(row ? table.number(*row, column, true)
                         : std::numeric_limits<double>::quiet_NaN());
  return pack_numbers(values);
}

/// Adds the columns of errors.csv, on the frames of track.csv.
void add_errors(const fs::path& file, const std::vector<int>& frames, Json& series) {
  const CsvTable table(file);
  const std::vector<const CsvTable::Row*> rows = rows_of(table, frames, file);
  require_column(table, "mean_joint_error_mm", file);
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    const std::string name(table.columns()[c]);
    if (name == "frame" || name == "time" || name == "status") continue;
    Json values = packed(table, static_cast<int>(c), rows);
    if (name == "mean_joint_error_mm")
      series["error"] = std::move(values);
    else
      series["models"][name] = std::move(values);
  }
}

/// Adds the truth's cost and the outcomes of truth_costs.csv, on the frames of track.csv.
void add_outcomes(const fs::path& file, const std::vector<int>& frames, Json& series) {
  const CsvTable table(file);
  const std::vector<const CsvTable::Row*> rows = rows_of(table, frames, file);
  series["truth_cost"] = packed(table, require_column(table, "truth_cost", file), rows);
  const int column = require_column(table, "outcome", file);
  std::string letters;
  for (const CsvTable::Row* row : rows) {
    const FrameOutcome outcome = row ? outcome_in(table, *row, column) : FrameOutcome::unknown;
    letters += outcome == FrameOutcome::unknown ? '-' : to_string(outcome).front();
  }
  series["outcome"] = letters;
}

}  // namespace

Json run_series(const fs::path& directory) {
  const fs::path file = directory / "track.csv";
  const CsvTable table(file);
  const int frame_column = require_column(table, "frame", file);
  std::vector<int> frames;
  bool plain = true;
  for (const CsvTable::Row& row : table.rows()) {
    frames.push_back(table.frame(row, frame_column));
    plain = plain && frames.back() == static_cast<int>(frames.size()) - 1;
  }
  Json series{{"count", frames.size()}};
  if (!plain) series["frames"] = frames;
  series["status"] = status_letters(table, require_column(table, "status", file), file);
  for (const char* name : {"time", "cost", "milliseconds"})
    series[name] = pack_numbers(numbers(table, require_column(table, name, file)));
  double evaluations = 0;
  for (const double value : numbers(table, require_column(table, "evaluations", file)))
    evaluations += value / static_cast<double>(frames.size());
  series["evaluations"] = evaluations;
  if (const fs::path errors = directory / "errors.csv"; fs::exists(errors))
    add_errors(errors, frames, series);
  if (const fs::path costs = directory / "truth_costs.csv"; fs::exists(costs))
    add_outcomes(costs, frames, series);
  return series;
}

}  // namespace hypotrack::internal
