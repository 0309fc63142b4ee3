// Times of image sequences: a number a line, or a column of a table.

#include "timestamps.hpp"

#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(timestamps, "csv") {
  TimestampSettings settings;
  settings.file = scratch_file("times.csv", bytes);
  bool read = false;
  for (const char* column : {"", "time"}) {
    settings.column = column;
    for (const TimeUnit unit : {TimeUnit::s, TimeUnit::ns}) {
      settings.unit = unit;
      read |= attempt([&] {
        require(rate_of(read_stamps(settings), unit, "times") > 0, "rates are positive");
      });
    }
  }
  if (!read) throw DataError("no times in any unit");
}

}  // namespace hypotrack::fuzz
