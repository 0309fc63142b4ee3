#include "plugin/param_keys.hpp"

#include <algorithm>

#include "hypotrack/api/text.hpp"

namespace hypotrack::detail::internal {
namespace {

/// Takes the text before the next two spaces.
std::string_view take_column(std::string_view& rest) {
  const std::size_t end = std::min(rest.find("  "), rest.size());
  const std::string_view column = rest.substr(0, end);
  rest = trimmed(rest.substr(end));
  return column;
}

HelpLine parse_help_line(std::string_view line) {
  HelpLine out;
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  out.depth = indent / 2 > 0 ? indent / 2 - 1 : 0;
  std::string_view rest = line.substr(indent);
  out.key = take_column(rest);
  out.type = take_column(rest);
  out.help = rest;
  return out;
}

}  // namespace

std::vector<HelpLine> help_lines(std::string_view text) {
  std::vector<HelpLine> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out.push_back(parse_help_line(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace hypotrack::detail::internal
