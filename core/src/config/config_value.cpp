#include "hypotrack/api/config_value.hpp"

#include <fmt/format.h>

#include <cmath>

#include "config/overrides.hpp"
#include "config/yaml.hpp"
#include "config/yaml_text.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {

using detail::YamlNode;
using detail::YamlOrigin;

namespace {

std::unique_ptr<YamlNode> make_node(YamlNode::Kind kind) {
  auto node = std::make_unique<YamlNode>();
  node->kind = kind;
  return node;
}

std::string number_text(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return fmt::format("{}", value);
}

/// Gives a node and all below it their origin. Returns how many there are.
std::size_t settle(YamlNode& node, const std::shared_ptr<const YamlOrigin>& origin) {
  node.origin = origin;
  const auto check = [&](const std::string& text) {
    if (!detail::is_text(text) || text.find('\0') != std::string::npos)
      throw ConfigError(
          fmt::format("{}: expected UTF-8 text without zeros", detail::place_of(node)));
  };
  if (node.kind == YamlNode::Kind::kScalar) check(node.text);
  std::size_t count = 1;
  for (YamlNode::Entry& entry : node.entries) {
    check(entry.key);
    count += settle(*entry.value, origin);
  }
  return count;
}

}  // namespace

ConfigValue::ConfigValue(std::unique_ptr<YamlNode> node) : node_(std::move(node)) {}
ConfigValue::ConfigValue() : node_(make_node(YamlNode::Kind::kNull)) {}
ConfigValue::ConfigValue(bool value) : node_(detail::make_scalar(value ? "true" : "false", true)) {}
ConfigValue::ConfigValue(double value) : node_(detail::make_scalar(number_text(value), true)) {}
ConfigValue::ConfigValue(std::string_view text)
    : node_(detail::make_scalar(std::string(text), false)) {}
ConfigValue::ConfigValue(const ConfigValue& other) : node_(detail::clone(*other.node_)) {}
ConfigValue::ConfigValue(ConfigValue&&) noexcept = default;
ConfigValue& ConfigValue::operator=(ConfigValue other) noexcept {
  node_.swap(other.node_);
  return *this;
}
ConfigValue::~ConfigValue() = default;

ConfigValue ConfigValue::plain(std::string text) {
  return ConfigValue(detail::make_scalar(std::move(text), true));
}

ConfigValue ConfigValue::map(const Map& entries) {
  auto node = make_node(YamlNode::Kind::kMap);
  for (const auto& [key, value] : entries) {
    if (node->find(key)) throw ConfigError(fmt::format("a map has the key '{}' twice", key));
    node->add(key, detail::clone(*value.node_));
  }
  return ConfigValue(std::move(node));
}

ConfigValue ConfigValue::list(const List& items) {
  auto node = make_node(YamlNode::Kind::kList);
  for (const ConfigValue& item : items) node->add("", detail::clone(*item.node_));
  return ConfigValue(std::move(node));
}

ConfigNode ConfigValue::document(std::string name, const std::filesystem::path& directory) const {
  auto origin = std::make_shared<YamlOrigin>();
  origin->name = std::move(name);
  origin->directory =
      std::filesystem::absolute(directory.empty() ? std::filesystem::current_path() : directory);
  origin->is_program = true;
  if (detail::depth_of(*node_) > detail::kMaxYamlDepth)
    throw ConfigError(
        fmt::format("{}: nested deeper than {} levels", origin->name, detail::kMaxYamlDepth));
  auto root = detail::clone(*node_);
  if (settle(*root, origin) > detail::kMaxYamlNodes)
    throw ConfigError(fmt::format("{}: more than {} values, which no scene needs", origin->name,
                                  detail::kMaxYamlNodes));
  return ConfigNode(std::shared_ptr<const YamlNode>(std::move(root)));
}

}  // namespace hypotrack
