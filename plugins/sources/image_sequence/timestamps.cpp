#include "timestamps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/text.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{64} << 20;
constexpr long double kFarthest = 0x1p62L;  // differences of stamps do not overflow
constexpr std::array<std::string_view, 4> kUnits{"s", "ms", "us", "ns"};

Stamp nanoseconds_in(TimeUnit unit) {
  static constexpr std::array<Stamp, 4> kIn{1'000'000'000, 1'000'000, 1'000, 1};
  return kIn[static_cast<std::size_t>(unit)];
}

std::string_view name_of(TimeUnit unit) { return kUnits[static_cast<std::size_t>(unit)]; }

std::string read_text(const std::filesystem::path& file) {
  std::error_code error;
  const std::string name = file.string();
  if (!std::filesystem::is_regular_file(file, error)) {
    throw DataError(name + ": there is no such file; expected the times of the images");
  }
  if (std::filesystem::file_size(file, error) > kLargestFile || error) {
    throw DataError(name + ": is larger than 64 MiB; expected a time per line");
  }
  std::optional<std::string> text = read_whole(file);
  if (!text) throw DataError(name + ": cannot be read; check its permissions");
  if (text->find('\0') != std::string::npos) {
    throw DataError(name + ": is no text; expected a time per line");
  }
  if (text->starts_with("\xEF\xBB\xBF")) text->erase(0, 3);  // byte order mark of UTF-8
  return std::move(*text);
}

struct Line {
  int number;
  std::string_view text;
};

/// Returns the lines that are not empty.
std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    ++number;
    if (!line.empty()) lines.push_back({number, line});
  }
  return lines;
}

bool is_comment(std::string_view line) { return line.front() == '#'; }

/// Returns what separates the cells of a table, by its header: a decimal comma separates none.
char separator_of(std::string_view header) {
  for (const char one : {';', '\t'})
    if (header.find(one) != std::string_view::npos) return one;
  return ',';
}

std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
    cells.emplace_back(trimmed(line.substr(begin, end - begin), " \t\r\""));
    begin = end + 1;
  }
  return cells;
}

/// The column of a table that has the times.
struct Column {
  std::size_t index = 0;
  std::size_t count = 0;  ///< of all columns
  char separator = ',';
  std::size_t first_line = 0;  ///< of the lines, behind the header
};

Column find_column(const std::vector<Line>& lines, const TimestampSettings& settings) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view header = trimmed(lines[i].text, "# \t");
    const char separator = separator_of(header);
    const std::vector<std::string> cells = cells_of(header, separator);
    const auto found = std::ranges::find(cells, settings.column);
    if (found != cells.end())
      return {static_cast<std::size_t>(found - cells.begin()), cells.size(), separator, i + 1};
    if (!is_comment(lines[i].text)) break;
  }
  const std::string_view first = trimmed(lines.front().text, "# \t");
  const std::vector<std::string> names = cells_of(first, separator_of(first));
  throw DataError(fmt::format("{}:{}: there is no column '{}'; expected one of {}{}",
                              settings.file.string(), lines.front().number, settings.column,
                              printable(fmt::format("{}", fmt::join(names, ", "))),
                              did_you_mean(settings.column, names)));
}

/// Returns the cell of a row that has the time. Throws DataError if the row does not fit the
/// header.
std::string cell_of(std::string_view row, const Column& column, std::string_view name,
                    const std::string& where) {
  std::vector<std::string> cells = cells_of(row, column.separator);
  if (cells.size() <= column.index)
    throw DataError(fmt::format("{}: has {} columns; expected '{}' in column {}", where,
                                cells.size(), name, column.index + 1));
  while (cells.size() > column.count && cells.back().empty()) cells.pop_back();
  if (cells.size() > column.count)
    throw DataError(fmt::format(
        "{}: has {} columns, its header {}; expected as many: write numbers with a point, and no "
        "commas within texts",
        where, cells.size(), column.count));
  return std::move(cells[column.index]);
}

/// Throws DataError if a line is the header or a row of a table.
void refuse_table(std::string_view line, const std::string& where) {
  double number = 0;
  const bool is_number = std::from_chars(line.data(), line.data() + line.size(), number).ec !=
                         std::errc::invalid_argument;
  if (is_number && line.find_first_of(",;\t") == std::string_view::npos) return;
  throw DataError(
      fmt::format("{}: '{}' is no number alone; expected one, or the name of a table's column in "
                  "timestamps.column",
                  where, printable(line)));
}

void expect_later(Stamp before, int line_before, Stamp now, std::string_view text,
                  const std::string& where) {
  if (now > before) return;
  if (now == before) {
    throw DataError(
        fmt::format("{}: the time {} is that of line {}, too; expected one line per image", where,
                    printable(text), line_before));
  }
  throw DataError(
      fmt::format("{}: the time {} is {:.6g} s before that of line {}; expected times that grow, "
                  "in the order of the images",
                  where, printable(text), seconds_between(now, before), line_before));
}

}  // namespace

std::span<const std::string_view> enum_names(TimestampOrigin) {
  static constexpr std::array<std::string_view, 2> names{"file", "names"};
  return names;
}

std::span<const std::string_view> enum_names(TimeUnit) { return kUnits; }

void check(const TimestampSettings& settings, const std::string& where) {
  if (!settings.given()) return;
  const bool names = settings.from == TimestampOrigin::names;
  const auto fail = [&](const char* what) { throw ConfigError(where + ": timestamps: " + what); };
  if (names && !settings.file.empty())
    fail("a file is given together with `from: names`; expected one of the two");
  if (!names && settings.file.empty())
    fail("nothing says where the times are; expected `file` or `from: names`");
  if (names && !settings.column.empty())
    fail("`column` is given with `from: names`; expected it with a `file` only");
  if (!names && settings.tolerance > 0)
    fail("`tolerance_ms` is given with a file; expected it with `from: names` only");
  if (!settings.unit) fail("no unit is given; expected `unit`: s, ms, us or ns");
}

double seconds_between(Stamp first, Stamp last) {
  return static_cast<double>(1e-9L * (static_cast<long double>(last) - first));
}

Stamp parse_stamp(std::string_view text, TimeUnit unit, const std::string& where) {
  long double value = 0;  // holds all numbers of 19 digits
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  if (failure == std::errc::invalid_argument || stop != end || std::isnan(value)) {
    throw DataError(fmt::format("{}: '{}' is no time; expected a number of {}", where,
                                printable(text), name_of(unit)));
  }
  value *= nanoseconds_in(unit);
  if (failure != std::errc{} || !(std::abs(value) < kFarthest)) {
    throw DataError(
        fmt::format("{}: the time {} {} is out of range; expected less than 146 years from 0: is "
                    "`unit` right?",
                    where, printable(text), name_of(unit)));
  }
  return std::llround(value);
}

std::optional<TimeUnit> unit_of_name(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789";
  constexpr std::size_t kSeconds = 10;  // digits from 2001 to 2286
  const auto digits_at_end = [&](std::string_view all) {
    const std::size_t before = all.find_last_not_of(kDigits);
    return before == std::string_view::npos ? all.size() : all.size() - before - 1;
  };
  const std::size_t last = digits_at_end(text);
  const std::string_view rest = text.substr(0, text.size() - last);
  if (last > 0 && rest.ends_with('.'))
    return digits_at_end(rest.substr(0, rest.size() - 1)) == kSeconds ? std::optional(TimeUnit::s)
                                                                      : std::nullopt;
  for (const TimeUnit unit : {TimeUnit::ms, TimeUnit::us, TimeUnit::ns})
    if (last == kSeconds + 3 * static_cast<std::size_t>(unit)) return unit;
  return std::nullopt;
}

std::vector<Stamp> read_stamps(const TimestampSettings& settings) {
  const std::string text = read_text(settings.file);
  const std::vector<Line> lines = lines_of(text);
  if (lines.empty())
    throw DataError(settings.file.string() + ": is empty; expected a time per line");
  const bool table = !settings.column.empty();
  const Column column = table ? find_column(lines, settings) : Column{};
  std::vector<Stamp> stamps;
  int line_before = 0;
  for (std::size_t i = column.first_line; i < lines.size(); ++i) {
    const Line& line = lines[i];
    if (is_comment(line.text)) continue;
    const std::string where = fmt::format("{}:{}", settings.file.string(), line.number);
    std::string cell(line.text);
    if (table) {
      cell = cell_of(line.text, column, settings.column, where);
    } else {
      refuse_table(line.text, where);
    }
    const Stamp stamp = parse_stamp(cell, *settings.unit, where);
    if (!stamps.empty()) expect_later(stamps.back(), line_before, stamp, cell, where);
    stamps.push_back(stamp);
    line_before = line.number;
  }
  if (stamps.empty())
    throw DataError(settings.file.string() + ": has no time; expected one per line");
  return stamps;
}

double rate_of(std::span<const Stamp> stamps, TimeUnit unit, const std::string& where) {
  constexpr double kSlowest = 0.1, kFastest = 2000;
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i)
    steps.push_back(seconds_between(stamps[i - 1], stamps[i]));
  if (steps.empty()) return 30;
  const double step = upper_median(std::move(steps));
  const double rate = 1 / step;
  if (rate >= kSlowest && rate <= kFastest) return rate;
  std::string advice;
  for (const TimeUnit other : {TimeUnit::s, TimeUnit::ms, TimeUnit::us, TimeUnit::ns}) {
    const double would_be = rate * static_cast<double>(nanoseconds_in(unit)) /
                            static_cast<double>(nanoseconds_in(other));
    if (would_be >= 1 && would_be <= 1000)
      advice = fmt::format(" With `unit: {}` it is {:.3g}.", name_of(other), would_be);
  }
  throw DataError(
      fmt::format("{}: the images are {:.3g} s apart in the median, {:.3g} frames per second; "
                  "expected {} to {}: is `unit: {}` right?{}",
                  where, step, rate, kSlowest, kFastest, name_of(unit), advice));
}

}  // namespace hypotrack
