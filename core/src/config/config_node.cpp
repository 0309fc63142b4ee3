#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/includes.hpp"
#include "config/overrides.hpp"
#include "config/yaml.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {

using detail::YamlNode;
using detail::YamlOrigin;

namespace {

/// Gives a document its tracker, references and overrides, and former keys their place of today.
std::shared_ptr<const YamlNode> resolved(std::unique_ptr<YamlNode> root, detail::Includes& includes,
                                         std::span<const std::string> overrides,
                                         std::vector<std::string>* notes) {
  includes.move_former(*root);
  const std::vector<std::string> left = detail::take_tracker(*root, overrides, includes);
  std::vector<std::string> path;
  includes.resolve(root, path);
  for (const std::string& assignment : left) {
    const auto today = includes.override_today(*root, assignment);
    if (today) detail::apply_override(*root, *today, assignment);
  }
  includes.move_former(*root);
  if (notes) *notes = includes.notes();
  return root;
}

}  // namespace

ConfigNode::ConfigNode() = default;
ConfigNode::ConfigNode(std::shared_ptr<const YamlNode> node) : node_(std::move(node)) {}

ConfigNode ConfigNode::load(const std::filesystem::path& file) {
  return ConfigNode(std::shared_ptr<const YamlNode>(detail::read_yaml_file(file)));
}

ConfigNode ConfigNode::load_scene(const std::filesystem::path& file,
                                  std::span<const std::string> overrides,
                                  std::vector<std::string>* notes) {
  detail::Includes includes(file);
  return ConfigNode(resolved(detail::read_yaml_file(file), includes, overrides, notes));
}

ConfigNode ConfigNode::as_scene(std::span<const std::string> overrides,
                                std::vector<std::string>* notes) const {
  if (!defined()) throw ConfigError("a scene is a map; found a document without a value");
  detail::Includes includes;
  return ConfigNode(resolved(detail::clone(*node_), includes, overrides, notes));
}

ConfigNode ConfigNode::load_study(const std::filesystem::path& file) {
  return ConfigNode(std::shared_ptr<const YamlNode>(detail::read_study_file(file)));
}

ConfigNode ConfigNode::parse(std::string_view text, std::string name,
                             std::filesystem::path directory) {
  return ConfigNode(
      std::shared_ptr<const YamlNode>(detail::read_document(text, std::move(name), directory)));
}

ConfigNode ConfigNode::parse_toml(std::string_view text, std::string name) {
  auto origin = std::make_shared<YamlOrigin>();
  origin->name = std::move(name);
  return ConfigNode(std::shared_ptr<const YamlNode>(detail::read_toml(text, origin)));
}

ConfigNode ConfigNode::map_of(std::span<const std::pair<std::string, ConfigNode>> entries) {
  auto map = std::make_shared<YamlNode>();
  map->kind = YamlNode::Kind::kMap;
  map->origin = std::make_shared<YamlOrigin>();
  for (const auto& [key, value] : entries) {
    if (!value.defined()) continue;
    if (map->entries.empty()) {
      auto origin = std::make_shared<YamlOrigin>(*value.node_->origin);
      origin->path = value.path();
      map->origin = std::move(origin);
      map->line = value.node_->line;
      map->column = value.node_->column;
    }
    map->add(key, detail::clone(*value.node_));
  }
  return ConfigNode(std::shared_ptr<const YamlNode>(std::move(map)));
}

bool ConfigNode::defined() const { return node_ && !missing_; }
bool ConfigNode::is_map() const { return defined() && node_->kind == YamlNode::Kind::kMap; }
bool ConfigNode::is_list() const { return defined() && node_->kind == YamlNode::Kind::kList; }
bool ConfigNode::is_scalar() const { return defined() && !is_map() && !is_list(); }
bool ConfigNode::is_null() const { return defined() && node_->kind == YamlNode::Kind::kNull; }
bool ConfigNode::is_plain() const { return is_scalar() && node_->plain; }

std::size_t ConfigNode::size() const { return defined() ? node_->entries.size() : 0; }

std::vector<std::string> ConfigNode::keys() const {
  std::vector<std::string> keys;
  if (!is_map()) return keys;
  for (const auto& entry : node_->entries) keys.push_back(entry.key);
  return keys;
}

ConfigNode ConfigNode::missing(std::string_view step) const {
  ConfigNode absent = *this;
  absent.missing_ = missing_ ? detail::join_path(*missing_, std::string(step)) : std::string(step);
  return absent;
}

ConfigNode ConfigNode::get(std::string_view key) const {
  const auto* entry = is_map() ? node_->find(key) : nullptr;
  if (!entry) return missing(key);
  return ConfigNode(std::shared_ptr<const YamlNode>(node_, entry->value.get()));
}

ConfigNode ConfigNode::at(std::size_t index) const {
  if (!is_list() || index >= node_->entries.size()) return missing(std::to_string(index));
  return ConfigNode(std::shared_ptr<const YamlNode>(node_, node_->entries[index].value.get()));
}

const std::string& ConfigNode::scalar() const {
  static const std::string empty;
  return is_scalar() ? node_->text : empty;
}

std::string ConfigNode::where() const {
  if (!node_) return "(nowhere)";
  if (missing_ && node_->origin->is_program)
    return fmt::format("{}: {}", node_->origin->name, path());
  return detail::place_of(*node_);
}

std::string ConfigNode::where_key(std::string_view key) const {
  const auto* entry = is_map() ? node_->find(key) : nullptr;
  if (!entry) return where();
  if (entry->value->origin->is_program) return detail::place_of(*entry->value);
  return detail::describe_position(*entry->value->origin, entry->line, entry->column);
}

std::string ConfigNode::path() const {
  const std::string missing = missing_.value_or("");
  return node_ ? detail::join_path(detail::path_of(*node_), missing) : missing;
}

ConfigNode ConfigNode::placed_at(std::string path) const {
  if (!defined()) return *this;
  auto origin = std::make_shared<YamlOrigin>(*node_->origin);
  origin->path = std::move(path);
  return ConfigNode(std::shared_ptr<const YamlNode>(detail::read_yaml(to_yaml(), origin)));
}

const std::filesystem::path& ConfigNode::directory() const {
  static const std::filesystem::path none;
  return node_ ? node_->origin->directory : none;
}

std::string ConfigNode::to_yaml() const { return defined() ? detail::write_yaml(*node_) : ""; }

}  // namespace hypotrack
