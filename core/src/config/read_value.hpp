#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Begins the names of what a program holds in place of a file: `attached:cube`.
inline constexpr std::string_view kAttached = "attached:";

/// Returns a position with a key path: `scene.yaml:3:5: optimizer.particles`.
std::string with_path(const std::string& where, const std::string& path);

/// Throws ConfigError with the text `scene.yaml:3:5: optimizer.particles: problem`.
[[noreturn]] void fail_at(const ConfigNode& node, std::string_view problem);

/// Describes the content of a node, for "found ..." in messages.
std::string describe_value(const ConfigNode& node);

/// Throws ConfigError with `expected` and what was found instead.
[[noreturn]] void fail_type(const ConfigNode& node, std::string_view expected);

/// Throws ConfigError for an unknown key, with the nearest name and all allowed ones.
[[noreturn]] void fail_unknown(const ConfigNode& map, const std::string& key,
                               const std::vector<std::string>& allowed);

/// Describes a type with its range: "a number from 0 to 90 deg".
std::string with_range(std::string_view type, double min, double max, std::string_view unit);

/// Reads a number in range and multiplies it by `to_si`. Throws ConfigError.
double read_double(const ConfigNode& node, const ParamInfo& info);

/// Returns the text of a scalar that is not null. Throws ConfigError.
const std::string& read_text(const ConfigNode& node, std::string_view expected);

}  // namespace internal
}  // namespace hypotrack::detail
