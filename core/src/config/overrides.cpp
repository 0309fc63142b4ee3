#include "config/overrides.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "config/includes.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::detail::internal {
namespace {

std::unique_ptr<YamlNode>& list_slot(YamlNode& list, std::string_view step, std::string_view path,
                                     const std::string& say) {
  const std::size_t size = list.entries.size();
  const auto index = as_index(step);
  if (!index || *index > size) {
    throw ConfigError(fmt::format(
        "{}: '{}' is no item of the list '{}'; expected an index from 0 to {} ({} appends)", say,
        step, path, size, size));
  }
  if (*index == size) list.entries.push_back({});
  return list.entries[*index].value;
}

/// Returns the place of a child; creates it if it is missing.
std::unique_ptr<YamlNode>& slot(YamlNode& node, const std::string& step, std::string_view path,
                                const std::string& say) {
  if (node.kind == YamlNode::Kind::kNull) {
    node.kind = as_index(step) ? YamlNode::Kind::kList : YamlNode::Kind::kMap;
  }
  if (node.kind == YamlNode::Kind::kList) return list_slot(node, step, path, say);
  if (node.kind == YamlNode::Kind::kScalar) {
    throw ConfigError(
        fmt::format("{}: '{}' is the value '{}' and has no key '{}'", say, path, node.text, step));
  }
  const auto found = std::find_if(node.entries.begin(), node.entries.end(),
                                  [&](const auto& entry) { return entry.key == step; });
  if (found != node.entries.end()) return found->value;
  node.entries.push_back({step, 1, 1, nullptr});
  return node.entries.back().value;
}

/// Returns the scene's node at a path. Throws ConfigError if there is none.
const YamlNode& node_at(const YamlNode& root, const std::string& path, const std::string& say) {
  if (const YamlNode* node = find_at(root, split_path(path))) return *node;
  throw ConfigError(fmt::format(
      "{}: '@{}' stands for what the scene has at '{}', and there is nothing; a text that "
      "begins with @ is written with two, and the name of a scene file ends in .yaml",
      say, path, path));
}

/// Replaces references `@path` in an override's value by the scene's value at that path, and
/// `@@text` by the text `@text`.
void resolve_references(std::unique_ptr<YamlNode>& value, const YamlNode& root,
                        const YamlOrigin& written) {
  if (value->origin.get() != &written) return;  // copied from another scene
  for (auto& entry : value->entries) {
    resolve_references(entry.value, root, written);
    entry.value->parent = value.get();
  }
  if (value->kind != YamlNode::Kind::kScalar || !value->text.starts_with('@')) return;
  value->text.erase(0, 1);
  if (!value->text.starts_with('@')) value = clone(node_at(root, value->text, written.name));
}

}  // namespace

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

std::unique_ptr<YamlNode> read_unquoted(std::string_view text,
                                        const std::shared_ptr<const YamlOrigin>& origin) {
  if (!text.starts_with('@')) return read_yaml(text, origin);
  auto value = make_scalar(std::string(text), false);
  value->origin = origin;
  return value;
}

std::unique_ptr<YamlNode> read_assigned(const std::string& path, std::string_view text,
                                        const std::shared_ptr<const YamlOrigin>& origin) {
  auto value = read_unquoted(text, origin);
  resolve_includes(value, split_path(path));
  return value;
}

void assign(YamlNode& root, std::span<const std::string> path, std::unique_ptr<YamlNode> value,
            const std::string& say) {
  if (path.size() + depth_of(*value) > kMaxYamlDepth) {
    throw ConfigError(fmt::format("{}: nested deeper than {} levels", say, kMaxYamlDepth));
  }
  YamlNode* node = &root;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string so_far = fmt::format("{}", fmt::join(path.first(i), "."));
    auto& place = slot(*node, path[i], so_far, say);
    if (i + 1 == path.size()) {
      place = std::move(value);
    } else if (!place) {
      place = std::make_unique<YamlNode>();
      place->origin = value->origin;
    }
    place->parent = node;
    node = place.get();
  }
}

void apply_override(YamlNode& root, const std::string& assignment, const std::string& written) {
  const std::string say = "--set " + written;
  const std::size_t equals = assignment.find('=');
  const auto path = split_path(std::string_view(assignment).substr(0, equals));
  if (equals == std::string::npos || std::find(path.begin(), path.end(), "") != path.end()) {
    throw ConfigError(say + ": expected key.path=value, for example optimizer.particles=64");
  }
  auto origin = std::make_shared<YamlOrigin>();
  origin->name = say;
  origin->directory = std::filesystem::current_path();
  origin->is_override = true;
  auto value = read_assigned(assignment.substr(0, equals),
                             std::string_view(assignment).substr(equals + 1), origin);
  resolve_references(value, root, *origin);
  assign(root, path, std::move(value), say);
}

}  // namespace hypotrack::detail::internal
