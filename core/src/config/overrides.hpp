#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/yaml_node.hpp"

namespace hypotrack::detail {

/// Applies one `key.path=value`. Throws ConfigError, naming the override.
void apply_override(YamlNode& root, const std::string& assignment);

/// The steps of a path: `models.0.type`.
std::vector<std::string> split_path(std::string_view path);

/// Puts a value at a path below `root`, creating what is missing on the way. `say` is how messages
/// name the assignment.
void assign(YamlNode& root, std::span<const std::string> path, std::unique_ptr<YamlNode> value,
            const std::string& say);

}  // namespace hypotrack::detail
