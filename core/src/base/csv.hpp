#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the text of a CSV cell, quoted if it has a comma or a quote (RFC 4180). Replaces line
/// breaks by spaces.
std::string csv_cell(std::string_view text);

/// The cells of a CSV table with a header, as text.
class CsvTable {
 public:
  struct Row {
    int line = 0;  ///< of the file, from 1
    std::vector<std::string_view> cells;
  };

  /// Reads a file. Throws DataError on unreadable or empty files, files over 256 MiB, NUL
  /// characters, duplicate or empty column names and rows whose length is not the header's.
  explicit CsvTable(const std::filesystem::path& file);
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  const std::vector<std::string_view>& columns() const { return columns_; }
  const std::vector<Row>& rows() const { return rows_; }
  /// Returns the index of a column, -1 if it does not exist.
  int find(std::string_view column) const;

  /// Returns a cell as a number. "nan" and, if `empty_is_nan`, an empty cell are NaN. Throws
  /// DataError.
  double number(const Row& row, int column, bool empty_is_nan) const;
  /// Returns a cell as a frame number, 0 .. 2^31 - 1. Throws DataError.
  int frame(const Row& row, int column) const;
  /// Returns the place of a row for messages: `poses.csv:12`.
  std::string where(const Row& row) const;

 private:
  void read_line(std::string_view line, int number);

  std::string name_;
  std::string text_;
  std::vector<std::string_view> columns_;
  std::vector<Row> rows_;
};

}  // namespace internal
}  // namespace hypotrack
