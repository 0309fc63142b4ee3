#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "doctor/check.hpp"

namespace hypotrack::doctor {
namespace {

/// Indents all lines of a text but the first.
std::string indented(std::string_view text, std::size_t width) {
  std::string out;
  for (const char c : text) {
    out += c;
    if (c == '\n') out.append(width, ' ');
  }
  return out;
}

std::string conclusion(std::span<const Check> checks) {
  const auto is_problem = [](const Check& check) { return check.state != State::ok; };
  const auto problems = std::ranges::count_if(checks, is_problem);
  const auto needed = std::ranges::count_if(
      checks, [&](const Check& check) { return is_problem(check) && check.needed; });
  if (problems == 0) return "everything is there\n";
  if (needed == 0)
    return fmt::format("everything that runs need is there; {} optional part{} not\n", problems,
                       problems == 1 ? " is" : "s are");
  return fmt::format("{} that runs need {} missing or broken\n",
                     needed == 1 ? "1 part" : fmt::format("{} parts", needed),
                     needed == 1 ? "is" : "are");
}

}  // namespace

bool is_ready(std::span<const Check> checks) {
  return std::ranges::none_of(
      checks, [](const Check& check) { return check.needed && check.state != State::ok; });
}

std::string text_of(std::span<const Check> checks) {
  constexpr std::size_t kState = 7;  // length of the longest word
  std::size_t name = 5;
  for (const Check& check : checks) name = std::max(name, check.name.size());
  const std::size_t indent = kState + name + 4;
  std::string text = fmt::format("{:<{}}  {:<{}}  {}\n", "STATE", kState, "CHECK", name, "FOUND");
  for (const Check& check : checks) {
    text += fmt::format("{:<{}}  {:<{}}  {}\n", word_of(check.state), kState, check.name, name,
                        indented(check.found, indent));
    if (check.state == State::ok || check.fix.empty()) continue;
    text += fmt::format("{:<{}}fix: {}\n", "", indent, indented(check.fix, indent));
  }
  return text + conclusion(checks);
}

std::string json_of(std::span<const Check> checks) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Check& check : checks)
    rows.push_back({{"name", check.name},
                    {"state", word_of(check.state)},
                    {"needed", check.needed},
                    {"found", check.found},
                    {"fix", check.state == State::ok ? "" : check.fix}});
  const nlohmann::ordered_json report = {{"ready", is_ready(checks)}, {"checks", rows}};
  return report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace hypotrack::doctor
