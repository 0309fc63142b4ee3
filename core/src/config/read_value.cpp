#include "config/read_value.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/numbers.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"

namespace hypotrack::detail::internal {

std::string with_path(const std::string& where, const std::string& path) {
  // A document that a program made has the path in its positions.
  return path.empty() || where.ends_with(": " + path) ? where : fmt::format("{}: {}", where, path);
}

void fail_at(const ConfigNode& node, std::string_view problem) {
  std::string path = node.path();
  std::ranges::replace_if(
      path, [](unsigned char c) { return c < 32 || c == 127; }, '?');
  throw ConfigError(fmt::format("{}: {}", with_path(node.where(), path), problem));
}

std::string describe_value(const ConfigNode& node) {
  if (node.is_map()) return node.size() == 0 ? "an empty map" : "a map";
  if (node.is_list()) return fmt::format("a list of {}", node.size());
  if (node.is_null()) return "null";
  constexpr std::size_t kLongest = 60;
  const std::string& text = node.scalar();
  const std::string shown = text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
  return node.is_plain() ? fmt::format("'{}'", shown) : fmt::format("the text \"{}\"", shown);
}

void fail_type(const ConfigNode& node, std::string_view expected) {
  if (node.is_null()) {
    fail_at(node, fmt::format("is null; expected {} (a key that has a default may be left out)",
                              expected));
  }
  fail_at(node, fmt::format("expected {}, found {}", expected, describe_value(node)));
}

std::string with_range(std::string_view type, double min, double max, std::string_view unit) {
  const std::string range = describe_range(min, max, unit);
  if (!range.empty()) return fmt::format("{} {}", type, range);
  return unit.empty() ? std::string(type) : fmt::format("{} in {}", type, unit);
}

double read_double(const ConfigNode& node, const ParamInfo& info) {
  const std::string expected = with_range("a number", info.min, info.max, info.unit);
  const auto number = node.is_plain() ? parse_number(node.scalar()) : std::optional<double>();
  if (!number) fail_type(node, expected);
  if (std::isnan(*number)) fail_at(node, fmt::format("expected {}, found not-a-number", expected));
  // Converting a limit by the unit's factor and back may change its last bits.
  const double slack = info.to_si == 1.0 ? 0.0 : 1e-15;
  if (*number < info.min - slack * std::abs(info.min) ||
      *number > info.max + slack * std::abs(info.max)) {
    fail_at(node, fmt::format("{} is out of range; expected {}", node.scalar(), expected));
  }
  return scale_number(node.scalar(), *number, info.to_si);
}

const std::string& read_text(const ConfigNode& node, std::string_view expected) {
  if (!node.is_scalar() || node.is_null()) fail_type(node, expected);
  return node.scalar();
}

void fail_unknown(const ConfigNode& map, const std::string& key,
                  const std::vector<std::string>& allowed) {
  const std::string hint = did_you_mean(key, allowed);
  throw ConfigError(
      fmt::format("{}: unknown key{} Allowed: {}",
                  with_path(map.where_key(key), map.get(key).path()), hint.empty() ? "." : hint,
                  allowed.empty() ? "nothing" : fmt::format("{}", fmt::join(allowed, ", "))));
}

}  // namespace hypotrack::detail::internal
