#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Parses a number of YAML 1.2's core schema: decimal, `.inf`, `.nan`. Returns nothing for other
/// texts and numbers beyond a double.
std::optional<double> parse_number(std::string_view text);

/// Parses an integer, also one written as `1e3`.
std::optional<std::int64_t> parse_integer(std::string_view text);

/// Returns the number that `text` represents times `to_si`. Uses extended precision for texts of
/// more than 17 digits: not every double is a double times `to_si`, and a dump must reach all.
double scale_number(std::string_view text, double number, double to_si);

/// Returns the shortest text that scale_number() converts to exactly `value`.
std::string format_number(double value, double to_si);

/// Describes a range as "from 2 to 64 mm" or "at least 0"; empty without bounds.
std::string describe_range(double min, double max, std::string_view unit);

}  // namespace internal
}  // namespace hypotrack::detail
