#include "config/includes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "config/former_keys.hpp"
#include "config/overrides.hpp"
#include "config/yaml.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"

namespace hypotrack::detail::internal {
namespace {

/// The file and key path of an include `@FILE.yaml` or `@FILE.yaml#key.path`.
struct Include {
  std::filesystem::path file;
  std::optional<std::string> path;
};

std::optional<Include> include_of(const YamlNode& node) {
  std::string_view text = node.text;
  if (node.kind != YamlNode::Kind::kScalar || !text.starts_with('@') || text.starts_with("@@"))
    return std::nullopt;
  text.remove_prefix(1);
  const std::size_t hash = text.find('#');
  const std::string_view file = text.substr(0, hash);
  if (!file.ends_with(".yaml") && !file.ends_with(".yml")) return std::nullopt;
  Include include{file, std::nullopt};
  if (hash != std::string_view::npos) include.path = text.substr(hash + 1);
  return include;
}

std::size_t count_of(const YamlNode& node) {
  std::size_t count = 1;
  for (const auto& entry : node.entries) count += count_of(*entry.value);
  return count;
}

/// Throws ConfigError that says how far a path exists and what is there instead of its next step.
[[noreturn]] void fail_missing(const YamlNode& root, const std::string& file,
                               std::span<const std::string> path) {
  std::size_t known = 0;
  while (find_at(root, path.first(known + 1))) ++known;
  const YamlNode& last = *find_at(root, path.first(known));
  std::string there = "a value without keys";
  if (last.kind == YamlNode::Kind::kList) there = fmt::format("a list of {}", last.entries.size());
  if (last.kind == YamlNode::Kind::kMap) {
    std::vector<std::string> keys;
    for (const auto& entry : last.entries) keys.push_back(entry.key);
    there = keys.empty() ? "an empty map"
                         : fmt::format("a map of {}{}", fmt::join(keys, ", "),
                                       did_you_mean(path[known], keys));
  }
  throw ConfigError(fmt::format(
      "{} has nothing at '{}'; expected a key path in it, after a #; {} is {}", file,
      fmt::join(path, "."),
      known == 0 ? "it" : fmt::format("its '{}'", fmt::join(path.first(known), ".")), there));
}

/// Returns what a document has where a path of version 0.2 leads; null: nothing.
std::unique_ptr<YamlNode> former_value(const YamlNode& root, std::span<const std::string> path) {
  if (path.empty() || path.front() != kTracker || root.kind != YamlNode::Kind::kMap) return nullptr;
  if (path.size() > 1) {
    const YamlNode* const found =
        find_at(root, split_path(path_today(fmt::format("{}", fmt::join(path, ".")))));
    return found ? clone(*found) : nullptr;
  }
  auto tracker = std::make_unique<YamlNode>();
  tracker->kind = YamlNode::Kind::kMap;
  tracker->origin = root.origin;
  for (const char* key : {"recovery", "uncertainty"})
    if (const YamlNode::Entry* entry = root.find(key)) tracker->add(key, clone(*entry->value));
  if (const YamlNode::Entry* status = root.find("status"))
    for (const YamlNode::Entry& entry : status->value->entries)
      tracker->add(entry.key, clone(*entry.value));
  return tracker->entries.empty() ? nullptr : std::move(tracker);
}

/// Returns one name for a file, however its path is written.
std::filesystem::path identity(const std::filesystem::path& file) {
  std::error_code error;
  const auto canonical = std::filesystem::canonical(file, error);
  return error ? file : canonical;
}

}  // namespace

Includes::Includes(const std::filesystem::path& file) {
  if (!file.empty()) documents_[identity(file)];
}

Includes::~Includes() = default;

void Includes::resolve(std::unique_ptr<YamlNode>& value, std::vector<std::string>& path) {
  for (std::size_t i = 0; i < value->entries.size(); ++i) {
    auto& entry = value->entries[i];
    path.push_back(value->kind == YamlNode::Kind::kList ? fmt::format("{}", i) : entry.key);
    resolve(entry.value, path);
    entry.value->parent = value.get();
    path.pop_back();
  }
  const auto include = include_of(*value);
  if (!include) return;
  try {
    value = included(value->origin->directory / include->file,
                     include->path ? split_path(*include->path) : path, path.size());
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: '{}' cannot be included: {}", place_of(*value), value->text,
                                  error.what()));
  }
}

std::unique_ptr<YamlNode> Includes::included(const std::filesystem::path& file,
                                             const std::vector<std::string>& path,
                                             std::size_t level) {
  const YamlNode& root = document(file.lexically_normal());
  const YamlNode* found = find_at(root, path);
  const std::unique_ptr<YamlNode> former = found ? nullptr : former_value(root, path);
  if (former) found = former.get();
  if (!found) fail_missing(root, root.origin->name, path);
  if (level + depth_of(*found) > kMaxYamlDepth)
    throw ConfigError(fmt::format("nested deeper than {} levels", kMaxYamlDepth));
  values_ += count_of(*found);
  if (values_ > kMaxYamlNodes)
    throw ConfigError(fmt::format("more than {} values are included", kMaxYamlNodes));
  return clone(*found);
}

std::optional<std::string> Includes::override_today(YamlNode& document,
                                                    const std::string& assignment) {
  return internal::override_today(document, assignment, notes_);
}

void Includes::move_former(YamlNode& document) {
  std::ranges::move(move_former_keys(document), std::back_inserter(notes_));
}

const YamlNode& Includes::document(const std::filesystem::path& file) {
  const auto [at, is_new] = documents_.try_emplace(identity(file));
  if (!is_new && !at->second)
    throw ConfigError(
        fmt::format("{} includes this file itself; write out one of the two", file.string()));
  if (is_new) {
    auto root = read_yaml_file(file);
    move_former(*root);
    take_tracker(*root, {}, *this);
    std::vector<std::string> path;
    resolve(root, path);
    at->second = std::move(root);
  }
  return *at->second;
}

void resolve_includes(std::unique_ptr<YamlNode>& value, std::vector<std::string> path) {
  Includes includes;
  includes.resolve(value, path);
}

}  // namespace hypotrack::detail::internal
