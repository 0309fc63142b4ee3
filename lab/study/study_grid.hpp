#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/config.hpp"
#include "lab/study/study_file.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads changes from a map of dotted keys to values; an undefined node gives none. Throws
/// ConfigError.
std::vector<Change> read_changes(const ConfigNode& map);

/// Returns the value of a change, with its includes resolved. File names are relative to
/// `directory`. Throws ConfigError.
std::string content_of(const Change& change, const std::filesystem::path& directory);

/// Adds changes; one of the same key replaces an earlier one.
void add_changes(std::vector<Change>& changes, const std::vector<Change>& more);

/// Reads the axes of `grid:`, in the order of the file. Throws ConfigError.
std::vector<Axis> read_grid(const ConfigNode& grid);

/// Replaces the choices of axes, as a variant does. Throws ConfigError if an axis does not exist.
void replace_choices(std::vector<Axis>& axes, const ConfigNode& grid);

}  // namespace internal
}  // namespace hypotrack::study
