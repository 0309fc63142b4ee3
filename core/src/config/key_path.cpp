#include "config/key_path.hpp"

#include <algorithm>
#include <charconv>

namespace hypotrack::detail {

std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> steps;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    steps.emplace_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return steps;
}

std::optional<std::size_t> as_index(std::string_view step) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), index);
  if (error != std::errc() || end != step.data() + step.size()) return std::nullopt;
  return index;
}

const YamlNode* find_at(const YamlNode& root, std::span<const std::string> path) {
  const YamlNode* node = &root;
  for (const std::string& step : path) {
    const auto index = as_index(step);
    const YamlNode::Entry* entry = node->find(step);
    if (node->kind == YamlNode::Kind::kList && index && *index < node->entries.size())
      entry = &node->entries[*index];
    if (!entry) return nullptr;
    node = entry->value.get();
  }
  return node;
}

std::size_t depth_of(const YamlNode& node) {
  std::size_t deepest = 0;
  for (const auto& entry : node.entries) deepest = std::max(deepest, depth_of(*entry.value));
  const bool nests = node.kind == YamlNode::Kind::kList || node.kind == YamlNode::Kind::kMap;
  return deepest + (nests ? 1 : 0);
}

}  // namespace hypotrack::detail
