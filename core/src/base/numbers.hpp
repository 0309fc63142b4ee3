#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// A number of YAML 1.2's core schema: decimal, `.inf`, `.nan`. Nothing if the text is none or does
/// not fit a double.
HYPOTRACK_API std::optional<double> parse_number(std::string_view text);

/// An integer, also written as `1e3`.
HYPOTRACK_API std::optional<std::int64_t> parse_integer(std::string_view text);

/// The number a text stands for times `to_si`. Texts of more than 17 digits are multiplied in
/// extended precision: not every double is a double times `to_si`, and a dump must reach all.
HYPOTRACK_API double scale_number(std::string_view text, double number, double to_si);

/// The shortest text that scale_number() turns into exactly `value`.
HYPOTRACK_API std::string format_number(double value, double to_si);

/// "from 2 to 64 mm", "at least 0", or nothing where everything is allowed.
HYPOTRACK_API std::string describe_range(double min, double max, std::string_view unit);

}  // namespace hypotrack::detail
