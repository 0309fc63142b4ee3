#pragma once

#include <filesystem>
#include <string_view>

#include "lab/json_file.hpp"

namespace hypotrack {

/// Returns whether a run's folder should have a metrics.json: it has one, or the run knew the
/// truth.
bool expects_metrics(const std::filesystem::path& folder);

/// Throws DataError if a number of a run's JSON file is none, or one that no run can have. Messages
/// end with `advice`.
void check_numbers(const Json& json, const std::filesystem::path& file, std::string_view advice);

}  // namespace hypotrack
