#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/params.hpp"

namespace hypotrack::detail {

/// Throws ConfigError: `scene.yaml:3:5: optimizer.particles: problem`.
[[noreturn]] HYPOTRACK_API void fail_at(const ConfigNode& node, std::string_view problem);

/// What a node holds, for "found ..." in messages.
std::string describe_value(const ConfigNode& node);

/// Throws ConfigError: `expected` and what was found instead.
[[noreturn]] HYPOTRACK_API void fail_type(const ConfigNode& node, std::string_view expected);

/// Throws ConfigError: unknown key, the nearest name and all allowed ones.
[[noreturn]] void fail_unknown(const ConfigNode& map, const std::string& key,
                               const std::vector<std::string>& allowed);

/// "a number from 0 to 90 deg".
std::string with_range(std::string_view type, double min, double max, std::string_view unit);

/// A number in range, times `to_si`. Throws ConfigError.
double read_double(const ConfigNode& node, const ParamInfo& info);

/// The text of a scalar that is not null. Throws ConfigError.
const std::string& read_text(const ConfigNode& node, std::string_view expected);

}  // namespace hypotrack::detail
