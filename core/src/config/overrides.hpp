#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "config/yaml_node.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// Applies one override `key.path=value`. Throws ConfigError, naming the override.
void apply_override(YamlNode& root, const std::string& assignment);

/// Parses the value of an assignment to `path` and replaces its references to other scenes. Throws
/// ConfigError.
HYPOTRACK_API std::unique_ptr<YamlNode> read_assigned(
    const std::string& path, std::string_view text,
    const std::shared_ptr<const YamlOrigin>& origin);

/// Sets the value at a path below `root` and creates missing nodes on the way. `say` names the
/// assignment in messages.
void assign(YamlNode& root, std::span<const std::string> path, std::unique_ptr<YamlNode> value,
            const std::string& say);

}  // namespace hypotrack::detail
