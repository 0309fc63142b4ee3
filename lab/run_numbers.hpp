#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "lab/json_file.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the names of all numbers that a run has at the top level of its files.
const std::vector<std::string>& run_numbers();

/// Returns whether a run's folder should have a metrics.json: it has one, or the run knew the
/// truth.
bool expects_metrics(const std::filesystem::path& folder);

/// Throws DataError if a number of a run's JSON file is none, or one that no run can have. Messages
/// end with `advice`.
void check_numbers(const Json& json, const std::filesystem::path& file, std::string_view advice);

}  // namespace internal
}  // namespace hypotrack
