#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

enum class TimestampOrigin { file, names };
std::span<const std::string_view> enum_names(TimestampOrigin);

enum class TimeUnit { s, ms, us, ns };
std::span<const std::string_view> enum_names(TimeUnit);

/// `timestamps:` of an image_sequence.
struct TimestampSettings {
  TimestampOrigin from = TimestampOrigin::file;
  std::filesystem::path file;
  std::string column;
  std::optional<TimeUnit> unit;
  double tolerance = 0;

  void visit(ParamVisitor& v) {
    v("from", from,
      {.help = "file: a line per image; names: in the file names, in place of their *"});
    v("file", file,
      {.help = "numbers, one per line, or a CSV table; in the order of the images, the first line "
               "is the first image"});
    v("column", column, {.help = "column of the table; without it a line is a number"});
    v("unit", unit, {.help = "unit of the times; has to be given"});
    v("tolerance_ms", tolerance,
      {.help = "for from: names, pictures of one frame differ in time by this at most",
       .min = 0,
       .max = 1000,
       .unit = "ms",
       .to_si = 1e-3});
  }

  bool given() const {
    return from == TimestampOrigin::names || !file.empty() || !column.empty() || unit;
  }
};

/// Throws ConfigError, naming `where`, if the settings are given but contradict each other or lack
/// something.
void check(const TimestampSettings& settings, const std::string& where);

/// Nanoseconds since any epoch, which a double would round to a quarter of a microsecond.
using Stamp = std::int64_t;

/// Returns the time between two stamps, in seconds.
double seconds_between(Stamp first, Stamp last);

/// Reads a number of the unit. Throws DataError, naming `where`, if the text is no number, NaN or
/// 146 years or more from 0.
Stamp parse_stamp(std::string_view text, TimeUnit unit, const std::string& where);

/// Returns the unit of a time since 1970 that ends a text, judged by its number of digits; nothing
/// if there is none.
std::optional<TimeUnit> unit_of_name(std::string_view text);

/// Reads the times of `settings.file`, in its order. Skips empty lines and lines that begin with #;
/// the column's name may be in such a line. Throws DataError, naming file and line, if there is no
/// such file or column, a line has no time, or times do not grow.
std::vector<Stamp> read_stamps(const TimestampSettings& settings);

/// Returns the frames per second, one over the median time between two frames; 30 for a single
/// frame. Throws DataError, naming `where`, if that is below 0.1 or above 2000: the unit is wrong.
double rate_of(std::span<const Stamp> stamps, TimeUnit unit, const std::string& where);

}  // namespace hypotrack
