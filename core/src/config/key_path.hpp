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

/// The steps of a path: `models.0.type`.
HYPOTRACK_API std::vector<std::string> split_path(std::string_view path);

/// A step into a list; nothing if it is no number.
std::optional<std::size_t> as_index(std::string_view step);

/// What is at a path below `root`; null if there is nothing.
const YamlNode* find_at(const YamlNode& root, std::span<const std::string> path);

/// Levels of maps and lists.
std::size_t depth_of(const YamlNode& node);

}  // namespace hypotrack::detail
