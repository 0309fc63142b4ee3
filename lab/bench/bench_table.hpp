#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "lab/bench/bench_plan.hpp"
#include "lab/bench/measure.hpp"

namespace hypotrack::bench {

/// A measurement and what was measured.
struct Row {
  int round = 1;
  std::size_t case_index = 0;  ///< into Plan::cases
  std::size_t way = 0;         ///< into Plan::ways
  Measurement measurement;
};

/// The median frame in words: `21.3 ms, 46.9 fps (50 frames)`, or why there is none.
HYPOTRACK_API std::string in_words(const Measurement& measurement);

/// One round as a table for people, with the devices and the reasons for gaps below it.
HYPOTRACK_API std::string table_text(const Plan& plan, const std::vector<Row>& rows, int round);

/// Throws ConfigError unless write_rows() knows the format of such a file.
HYPOTRACK_API void check_format(const std::filesystem::path& file);

/// Writes all rows as CSV or JSON, whichever the name ends in. Throws OutputError.
HYPOTRACK_API void write_rows(const std::filesystem::path& file, const Plan& plan,
                              const std::vector<Row>& rows);

}  // namespace hypotrack::bench
