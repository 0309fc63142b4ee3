#include "base/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "base/file_bytes.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/text.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{256} << 20;

std::string read_all(const std::filesystem::path& file) {
  if (const std::string why = why_no_file(file); !why.empty()) {
    throw DataError(fmt::format("{}: {}; expected a CSV table", file.string(), why));
  }
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kLargestFile) {
    throw DataError(
        fmt::format("{}: the table is larger than {} MiB", file.string(), kLargestFile >> 20));
  }
  std::optional<std::string> text = read_whole(file);
  if (!text)
    throw DataError(fmt::format("{}: cannot be read; check its permissions", file.string()));
  return std::move(*text);
}

/// Returns a cell without blanks and quotes around it.
std::string_view content_of(std::string_view cell) {
  cell = trimmed(cell);
  const bool quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  return quoted ? cell.substr(1, cell.size() - 2) : cell;
}

/// Returns a cell for a message: printable and not too long.
std::string shown(std::string_view cell) {
  std::string text(cell.substr(0, 40));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  }
  return text;
}

}  // namespace

std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return quoted + "\"";
}

CsvTable::CsvTable(const std::filesystem::path& file)
    : name_(file.string()), text_(read_all(file)) {
  std::string_view rest = text_;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  if (const std::size_t nul = rest.find('\0'); nul != std::string_view::npos) {
    throw DataError(fmt::format("{}: holds a NUL character; this is no CSV table", name_));
  }
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    read_line(rest.substr(0, end), line);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (columns_.empty()) {
    throw DataError(fmt::format("{}: is empty; expected a header line of column names", name_));
  }
}

void CsvTable::read_line(std::string_view line, int number) {
  const std::string_view content = content_of(line);
  if (content.empty() || content.front() == '#') return;
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(content_of(line.substr(0, comma)));
    if (comma == std::string_view::npos) break;
    line.remove_prefix(comma + 1);
  }
  if (!columns_.empty()) {
    if (cells.size() != columns_.size()) {
      throw DataError(fmt::format("{}:{}: has {} cells; expected {} as in the header", name_,
                                  number, cells.size(), columns_.size()));
    }
    rows_.push_back({number, std::move(cells)});
    return;
  }
  std::set<std::string_view> seen;
  for (const std::string_view name : cells) {
    if (name.empty()) {
      throw DataError(fmt::format("{}:{}: a column has no name; expected a header line of {} names",
                                  name_, number, cells.size()));
    }
    if (!seen.insert(name).second) {
      throw DataError(
          fmt::format("{}:{}: the column '{}' is there twice", name_, number, shown(name)));
    }
  }
  columns_ = std::move(cells);
}

int CsvTable::find(std::string_view column) const {
  const auto it = std::find(columns_.begin(), columns_.end(), column);
  return it == columns_.end() ? -1 : static_cast<int>(it - columns_.begin());
}

std::string CsvTable::where(const Row& row) const { return fmt::format("{}:{}", name_, row.line); }

double CsvTable::number(const Row& row, int column, bool empty_is_nan) const {
  const auto index = static_cast<std::size_t>(column);
  std::string_view cell = row.cells[index];
  if (cell.empty() && empty_is_nan) return std::numeric_limits<double>::quiet_NaN();
  if (cell.starts_with('+')) cell.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size()) {
    throw DataError(fmt::format("{}: column '{}' holds '{}'; expected a number", where(row),
                                shown(columns_[index]), shown(cell)));
  }
  return value;
}

int CsvTable::frame(const Row& row, int column) const {
  const double value = number(row, column, false);
  if (!(value >= 0 && value <= std::numeric_limits<int>::max()) || value != std::floor(value)) {
    throw DataError(fmt::format("{}: the frame number is {}; expected a whole number from 0 on",
                                where(row), value));
  }
  return static_cast<int>(value);
}

}  // namespace hypotrack::internal
