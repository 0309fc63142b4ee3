#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "camera/formats/zed_sections.hpp"
#include "hypotrack/api/text.hpp"

namespace hypotrack::calibration::internal {
namespace {

std::string upper(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

/// Returns the name of a section's line; empty if a line begins none.
std::string_view section_in(std::string_view line) {
  line = trimmed(line.substr(0, line.find_first_of(";#")));
  if (!line.starts_with('[') || !line.ends_with(']')) return {};
  return trimmed(line.substr(1, line.size() - 2));
}

/// Returns a name as readers know it, where only the case of its letters differs.
std::string usual_case(std::string_view name) {
  const std::string upper_name = upper(name);
  for (const Resolution& size : kResolutions) {  // LEFT_CAM_4k, RX_FHD
    const std::size_t mark = name.rfind('_');
    if (mark != name.npos && upper_name.substr(mark + 1) == upper(size.name))
      return fmt::format("{}_{}", upper_name.substr(0, mark), size.name);
  }
  for (const Keys keys : {Keys(kPinhole), Keys(kCoefficients), Keys(kThinPrism), Keys(kOtherNames)})
    for (const std::string_view key : keys)
      if (upper(key) == upper_name) return std::string(key);
  return std::string(name);
}

/// Returns a text without what has a meaning within quotes of TOML.
std::string plain(std::string text) {
  std::erase_if(text, [](char c) { return c == '"' || c == '\\'; });
  return text;
}

/// Returns a section's name as TOML writes it: in quotes where that has to be.
std::string table_name(const std::string& name) {
  const bool bare = std::ranges::all_of(
      name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
  return bare ? name : fmt::format("\"{}\"", plain(name));
}

/// Returns a line of an INI file as one of TOML, whose texts are in quotes.
std::string toml_line(std::string_view line) {
  if (const std::string_view section = section_in(line); !section.empty())
    return fmt::format("[{}]", table_name(usual_case(section)));
  line = trimmed(line.substr(0, line.find_first_of(";#")));
  const std::size_t mark = line.find_first_of("=:");
  if (mark == line.npos) return std::string(line);  // empty, or an error with its place
  return fmt::format("\"{}\" = \"{}\"", plain(usual_case(trimmed(line.substr(0, mark)))),
                     plain(std::string(trimmed(line.substr(mark + 1)))));
}

/// Calls `take` with each line of a text.
template <class Take>
void each_line(std::string_view text, Take take) {
  if (constexpr std::string_view kMark = "\xEF\xBB\xBF"; text.starts_with(kMark))
    text.remove_prefix(kMark.size());
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    take(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace

bool is_zed_text(std::string_view text) {
  bool found = false;
  each_line(text, [&](std::string_view line) {
    found = found || upper(section_in(line)).starts_with("LEFT_CAM_");
  });
  return found;
}

std::string zed_as_toml(std::string_view text) {
  std::string out;
  each_line(text, [&](std::string_view line) { out += toml_line(line) + "\n"; });
  return out;
}

}  // namespace hypotrack::calibration::internal
