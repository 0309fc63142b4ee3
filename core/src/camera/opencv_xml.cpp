#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/property_tree/xml_parser.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "camera/calibration_text.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

using Xml = boost::property_tree::ptree;

/// Returns a text in quotes, as one of JSON.
std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return out + '"';
}

/// Returns the words of a text; one in quotes may have spaces.
std::vector<std::string> words_of(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  std::vector<std::string> words;
  while (
      (text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size())), !text.empty())) {
    const bool quote = text.starts_with('"');
    if (quote) text.remove_prefix(1);
    const std::size_t end =
        std::min(quote ? text.find('"') : text.find_first_of(kBlank), text.size());
    words.push_back(json_text(text.substr(0, end)));
    text.remove_prefix(std::min(end + (quote ? 1 : 0), text.size()));
  }
  return words;
}

std::string list_of(const std::vector<std::string>& items) {
  return fmt::format("[{}]", fmt::join(items, ", "));
}

/// Returns an element as a value of JSON: a number or text, a list of `_`, or a map.
std::string value_of(const Xml& element, bool is_data) {
  std::vector<std::string> items, members;
  for (const auto& [name, child] : element) {
    if (name == "<xmlattr>" || name == "<xmlcomment>") continue;
    const std::string value = value_of(child, name == "data");
    items.push_back(value);
    members.push_back(fmt::format("{}: {}", json_text(name), value));
    if (name != "_") items.clear();
  }
  if (!members.empty())
    return items.size() == members.size() ? list_of(items)
                                          : fmt::format("{{{}}}", fmt::join(members, ", "));
  const std::vector<std::string> words = words_of(element.data());
  if (words.size() == 1 && !is_data) return words[0];
  return list_of(words);
}

/// Throws DataError if elements are nested deeper than those of calibrations: the parser calls
/// itself for each.
void check_depth(std::string_view text, const std::string& file) {
  constexpr int kDeepest = 32;
  int depth = 0;
  for (std::size_t at = text.find('<'); at != text.npos; at = text.find('<', at + 1)) {
    const char next = at + 1 < text.size() ? text[at + 1] : ' ';
    const std::size_t end = text.find('>', at);
    const bool closed = end != text.npos && end > 0 && text[end - 1] == '/';
    if (next == '/')
      --depth;
    else if (next != '?' && next != '!' && !closed)
      ++depth;
    if (depth > kDeepest)
      throw DataError(
          fmt::format("{}: its XML is nested deeper than {} levels, which no "
                      "calibration is",
                      file, kDeepest));
  }
}

}  // namespace

bool is_opencv_xml(std::string_view text) {
  constexpr std::size_t kHead = 4096;  // a comment may stand before
  return text.substr(0, kHead).find("<opencv_storage>") != text.npos;
}

std::string opencv_xml_as_json(const std::string& text, const std::string& file) {
  check_depth(text, file);
  std::istringstream in(text);
  Xml root;
  try {
    boost::property_tree::read_xml(in, root);
  } catch (const boost::property_tree::xml_parser_error& error) {
    throw DataError(fmt::format("{}:{}: the XML is damaged: {}; write the file again", file,
                                error.line(), error.message()));
  }
  const auto storage = root.get_child_optional("opencv_storage");
  std::string out = storage ? value_of(*storage, false) : "{}";
  return out.starts_with('{') ? out : "{}";
}

}  // namespace hypotrack::internal
