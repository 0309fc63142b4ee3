#include "lab/study/study_text.hpp"

#include <algorithm>
#include <cctype>

#include "config/yaml.hpp"

namespace hypotrack::study::internal {
namespace {

std::string on_one_line(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

std::string joined_items(const ConfigNode& list) {
  std::string text;
  for (std::size_t i = 0; i < list.size(); ++i) text += (i == 0 ? "" : ", ") + to_flow(list.at(i));
  return text;
}

std::string joined_entries(const ConfigNode& map) {
  std::string text;
  for (const std::string& key : map.keys()) {
    if (!text.empty()) text += ", ";
    text += (is_word(key) ? key : yaml_scalar(key)) + ": " + to_flow(map.get(key));
  }
  return text;
}

}  // namespace

std::string to_flow(const ConfigNode& node) {
  if (node.is_list()) return "[" + joined_items(node) + "]";
  if (node.is_map()) return "{" + joined_entries(node) + "}";
  return on_one_line(node.to_yaml());
}

std::string yaml_scalar(std::string_view text) {
  return on_one_line(detail::write_yaml(*detail::make_scalar(std::string(text), false)));
}

bool is_word(std::string_view text) {
  return !text.empty() && text.front() != '-' &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

}  // namespace hypotrack::study::internal
