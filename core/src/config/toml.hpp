#pragma once

#include <memory>
#include <string_view>

#include "base/exported.hpp"
#include "config/yaml.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Parses a TOML document, or sections of `key = value` lines, to the tree of the same YAML. Throws
/// ConfigError with the position, also on dates and times.
std::unique_ptr<YamlNode> read_toml(std::string_view text,
                                    const std::shared_ptr<const YamlOrigin>& origin);

}  // namespace internal
}  // namespace hypotrack::detail
