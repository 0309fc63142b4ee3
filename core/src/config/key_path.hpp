#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/yaml_node.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// Splits a path such as `models.0.type` into its steps.
HYPOTRACK_API std::vector<std::string> split_path(std::string_view path);

/// Returns a step as a list index, or nothing if it is not a number.
std::optional<std::size_t> as_index(std::string_view step);

/// Returns the node at a path below `root`, or null if there is none.
const YamlNode* find_at(const YamlNode& root, std::span<const std::string> path);

/// Returns the number of nested levels of maps and lists.
std::size_t depth_of(const YamlNode& node);

}  // namespace hypotrack::detail
