#include "config/yaml_document.hpp"

#include <algorithm>
#include <utility>

#include "config/yaml_node.hpp"
#include "config/yaml_reader.hpp"
#include "config/yaml_writer.hpp"

namespace hypotrack::detail {
namespace {

YamlNode::Entry* find_entry(YamlNode& map, std::string_view key) {
  const auto at = std::find_if(map.entries.begin(), map.entries.end(),
                               [&](const YamlNode::Entry& entry) { return entry.key == key; });
  return at == map.entries.end() ? nullptr : &*at;
}

}  // namespace

YamlDocument::YamlDocument(std::string_view text) {
  auto origin = std::make_shared<YamlOrigin>();
  origin->name = "resolved parameters";
  root_ = read_yaml(text, origin);
  if (root_->kind == YamlNode::Kind::kNull) root_->kind = YamlNode::Kind::kMap;
}
YamlDocument::~YamlDocument() = default;
YamlDocument::YamlDocument(YamlDocument&&) noexcept = default;
YamlDocument& YamlDocument::operator=(YamlDocument&&) noexcept = default;

void YamlDocument::set_node(std::string_view key, std::unique_ptr<YamlNode> value) {
  if (YamlNode::Entry* entry = find_entry(*root_, key)) {
    value->parent = root_.get();
    entry->value = std::move(value);
  } else {
    root_->add(std::string(key), std::move(value));
  }
}

void YamlDocument::set(std::string_view key, const YamlDocument& value) {
  set_node(key, clone(*value.root_));
}

void YamlDocument::set_string(std::string_view key, std::string_view value) {
  set_node(key, make_scalar(std::string(value), false));
}

void YamlDocument::set_plain(std::string_view key, std::string_view value) {
  set_node(key, make_scalar(std::string(value), true));
}

void YamlDocument::set_list(std::string_view key, std::span<const YamlDocument> items) {
  auto list = std::make_unique<YamlNode>();
  list->kind = YamlNode::Kind::kList;
  for (const YamlDocument& item : items) list->add("", clone(*item.root_));
  set_node(key, std::move(list));
}

std::string YamlDocument::text() const {
  std::string text = write_yaml(*root_);
  if (text.empty() || text.back() != '\n') text += '\n';
  return text;
}

}  // namespace hypotrack::detail
