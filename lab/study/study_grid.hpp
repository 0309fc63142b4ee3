#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/config.hpp"
#include "lab/study/study_file.hpp"

namespace hypotrack::study {

/// The changes of a map of dotted keys to values. Throws ConfigError; an undefined node has none.
std::vector<Change> read_changes(const ConfigNode& map);

/// The value of a change with the parts that it takes from other scenes, whose names refer to
/// `directory`. Throws ConfigError.
std::string content_of(const Change& change, const std::filesystem::path& directory);

/// Adds changes; one of the same key takes the place of an earlier one.
void add_changes(std::vector<Change>& changes, const std::vector<Change>& more);

/// The axes of `grid:`, in the order of the file. Throws ConfigError.
std::vector<Axis> read_grid(const ConfigNode& grid);

/// Gives axes other choices, as a variant does. Throws ConfigError where `axes` has no axis of a
/// name.
void replace_choices(std::vector<Axis>& axes, const ConfigNode& grid);

}  // namespace hypotrack::study
