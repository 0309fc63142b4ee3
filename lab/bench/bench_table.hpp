#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/bench/bench_plan.hpp"
#include "lab/bench/measure.hpp"

namespace hypotrack::bench {
inline namespace HYPOTRACK_EXPORTED internal {

/// A measurement with its round, case and configuration.
struct Row {
  int round = 1;
  std::size_t case_index = 0;     ///< into Plan::cases
  std::size_t configuration = 0;  ///< into Plan::configurations
  Measurement measurement;
};

/// Formats the median frame: `21.3 ms, 46.9 fps (50 frames)`, or why there is none.
std::string in_words(const Measurement& measurement);

/// Formats one round as a table for people, followed by the devices and the reasons for gaps.
std::string table_text(const Plan& plan, const std::vector<Row>& rows, int round);

/// Formats the parts of the frames of a round: milliseconds per frame, of them waiting for a GPU,
/// calls per frame. Empty without a profile.
std::string profile_text(const Plan& plan, const std::vector<Row>& rows, int round);

/// Throws ConfigError if write_rows() does not know the format of a file name.
void check_format(const std::filesystem::path& file);

/// Writes all rows as CSV or JSON, by the suffix of the name. Throws OutputError.
void write_rows(const std::filesystem::path& file, const Plan& plan, const std::vector<Row>& rows);

}  // namespace internal
}  // namespace hypotrack::bench
