#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "config/yaml.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Splits a path such as `models.0.type` into its steps.
std::vector<std::string> split_path(std::string_view path);

/// Returns a step as a list index, or nothing if it is not a number.
std::optional<std::size_t> as_index(std::string_view step);

/// Returns the node at a path below `root`, or null if there is none.
const YamlNode* find_at(const YamlNode& root, std::span<const std::string> path);

/// Returns the number of nested levels of maps and lists.
std::size_t depth_of(const YamlNode& node);

/// Applies one override `key.path=value`. Throws ConfigError, naming it as it was `written`.
void apply_override(YamlNode& root, const std::string& assignment, const std::string& written);

/// Parses the value of an assignment, where a text that begins with @ needs no quotes. Throws
/// ConfigError.
std::unique_ptr<YamlNode> read_unquoted(std::string_view text,
                                        const std::shared_ptr<const YamlOrigin>& origin);

/// Parses the value of an assignment to `path` and replaces its references to other scenes. Throws
/// ConfigError.
std::unique_ptr<YamlNode> read_assigned(const std::string& path, std::string_view text,
                                        const std::shared_ptr<const YamlOrigin>& origin);

/// Sets the value at a path below `root` and creates missing nodes on the way. `say` names the
/// assignment in messages.
void assign(YamlNode& root, std::span<const std::string> path, std::unique_ptr<YamlNode> value,
            const std::string& say);

}  // namespace internal
}  // namespace hypotrack::detail
