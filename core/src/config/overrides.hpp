#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "config/yaml_node.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// Applies one `key.path=value`. Throws ConfigError, naming the override.
void apply_override(YamlNode& root, const std::string& assignment);

/// The value of an assignment to `path`, with the parts that it takes from other scenes. Throws
/// ConfigError.
HYPOTRACK_API std::unique_ptr<YamlNode> read_assigned(
    const std::string& path, std::string_view text,
    const std::shared_ptr<const YamlOrigin>& origin);

/// Puts a value at a path below `root`, creating what is missing on the way. `say` is how messages
/// name the assignment.
void assign(YamlNode& root, std::span<const std::string> path, std::unique_ptr<YamlNode> value,
            const std::string& say);

}  // namespace hypotrack::detail
