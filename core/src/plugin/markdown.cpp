#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plugin/capabilities.hpp"
#include "plugin/inspect.hpp"
#include "plugin/param_keys.hpp"

namespace hypotrack::internal {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_') out += '\\';
    out += c;
  }
  return out;
}

/// Splits "number from 0 to 1, default 0.5" at the default.
std::pair<std::string_view, std::string_view> split_default(std::string_view type) {
  constexpr std::string_view kDefault = ", default ";
  const std::size_t at = type.find(kDefault);
  if (at == std::string_view::npos) return {type, {}};
  return {type.substr(0, at), type.substr(at + kDefault.size())};
}

/// Returns a sentence on the capabilities of every build; empty if there are none.
std::string capabilities(const PluginRow& row) {
  std::vector<std::string> words;
  std::istringstream in(row.capabilities);
  for (std::string word; in >> word;) {
    const Capability* known = find_capability(row.kind, word);
    if (!known || !known->by_build) words.push_back(fmt::format("`{}`", word));
  }
  if (words.empty()) return "";
  return fmt::format("[Capabilities](index.md#capabilities): {}.\n\n", fmt::join(words, ", "));
}

}  // namespace

std::string format_markdown(const PluginRow& row) {
  std::string summary = escaped(row.summary);
  if (!summary.empty())
    summary[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(summary[0])));
  std::string out = fmt::format("# {} `{}`\n\n{}.\n\n", row.kind, row.name, summary);
  out += capabilities(row);
  if (row.parameters.empty()) return out + "It has no parameters.\n";
  out += "| parameter | type | default | meaning |\n|---|---|---|---|\n";
  std::vector<std::string> path;
  for (const detail::HelpLine& line : detail::help_lines(row.parameters)) {
    path.resize(std::min(line.depth, path.size()));
    std::string name;
    for (const std::string& parent : path) name += parent + ".";
    const auto [type, value] = split_default(line.type);
    out += fmt::format("| `{}{}` | {} | {} | {} |\n", name, line.key,
                       escaped(type.starts_with("a map of")    ? "section"
                               : type.starts_with("a list of") ? "list"
                                                               : type),
                       value.empty() ? "" : fmt::format("`{}`", value), escaped(line.help));
    path.push_back(std::string(line.key));
  }
  return out;
}

}  // namespace hypotrack::internal
