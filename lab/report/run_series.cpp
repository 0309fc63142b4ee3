#include "lab/report/run_series.hpp"

#include <fmt/format.h>

#include <limits>
#include <map>

#include "base/csv.hpp"
#include "hypotrack/error.hpp"
#include "lab/json_file.hpp"
#include "lab/report/packed.hpp"
#include "output/metrics/status_metrics.hpp"

namespace hypotrack {
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

/// Adds the columns of errors.csv, on the frames of track.csv.
void add_errors(const fs::path& file, const std::vector<int>& frames, Json& series) {
  const CsvTable table(file);
  const int frame_column = require_column(table, "frame", file);
  require_column(table, "mean_joint_error_mm", file);
  std::map<int, std::size_t> row_of;
  for (std::size_t i = 0; i < table.rows().size(); ++i)
    row_of[table.frame(table.rows()[i], frame_column)] = i;
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    const std::string name(table.columns()[c]);
    if (name == "frame" || name == "time" || name == "status") continue;
    std::vector<double> values(frames.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < frames.size(); ++i)
      if (const auto it = row_of.find(frames[i]); it != row_of.end())
        values[i] = table.number(table.rows()[it->second], static_cast<int>(c), true);
    if (name == "mean_joint_error_mm")
      series["error"] = pack_numbers(values);
    else
      series["models"][name] = pack_numbers(values);
  }
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
  return series;
}

}  // namespace hypotrack
