#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "command_line.hpp"

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

OptionCheck whole_number(std::int64_t lowest, std::int64_t highest) {
  const auto check = [=](const std::string& text) {
    const auto value = parse<std::int64_t>(text);
    if (value && *value >= lowest && *value <= highest) return std::string();
    return fmt::format("expected a whole number from {} to {}, found '{}'", lowest, highest, text);
  };
  return {check, fmt::format("FROM {}", lowest)};
}

OptionCheck positive_number() {
  const auto check = [](const std::string& text) {
    const auto value = parse<double>(text);
    if (value && std::isfinite(*value) && *value > 0) return std::string();
    return fmt::format("expected a number above 0, found '{}'", text);
  };
  return {check, "ABOVE 0"};
}

OptionCheck file_name() {
  const auto check = [](const std::string& text) {
    return std::string(text.empty() ? "is empty, expected a name" : "");
  };
  return {check, ""};
}

OptionCheck existing_folder() {
  const auto check = [](const std::string& text) {
    std::error_code error;
    return std::filesystem::is_directory(text, error)
               ? std::string()
               : fmt::format("there is no folder '{}'", text);
  };
  return {check, ""};
}

OptionCheck one_of(std::vector<std::string> words) {
  std::string hint = fmt::format("{{{}}}", fmt::join(words, ","));
  const auto check = [=](const std::string& text) {
    if (std::ranges::find(words, text) != words.end()) return std::string();
    return fmt::format("{} not in {{{}}}", text, fmt::join(words, ","));
  };
  return {check, std::move(hint)};
}

}  // namespace hypotrack::app
