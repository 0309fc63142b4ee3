#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <system_error>

#include "commands.hpp"

namespace hypotrack::app {
namespace {

/// Parses a whole text as a number.
template <class T>
std::optional<T> parse(const std::string& text) {
  T value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

}  // namespace

CLI::Validator whole_number(std::int64_t lowest, std::int64_t highest) {
  const auto check = [=](std::string& text) {
    const auto value = parse<std::int64_t>(text);
    if (value && *value >= lowest && *value <= highest) return std::string();
    return fmt::format("expected a whole number from {} to {}, found '{}'", lowest, highest, text);
  };
  return {check, fmt::format("FROM {}", lowest)};
}

CLI::Validator positive_number() {
  const auto check = [](std::string& text) {
    const auto value = parse<double>(text);
    if (value && std::isfinite(*value) && *value > 0) return std::string();
    return fmt::format("expected a number above 0, found '{}'", text);
  };
  return {check, "ABOVE 0"};
}

CLI::Validator file_name() {
  const auto check = [](std::string& text) {
    return std::string(text.empty() ? "is empty, expected a name" : "");
  };
  return {check, ""};
}

}  // namespace hypotrack::app
