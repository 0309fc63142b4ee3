#include "config/yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/emitter.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "config/yaml_text.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::detail::internal {
namespace {

std::string step_of(const YamlNode& node) {
  const auto& siblings = node.parent->entries;
  const auto self = std::find_if(siblings.begin(), siblings.end(),
                                 [&](const auto& entry) { return entry.value.get() == &node; });
  if (node.parent->kind == YamlNode::Kind::kMap) return self->key;
  return std::to_string(self - siblings.begin());
}

bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) ||
         std::string_view("_./+-").find(c) != std::string_view::npos;
}

/// Words that YAML 1.1 or 1.2 readers parse as a bool, null or number.
bool is_reserved(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  static constexpr std::array kWords = {"true", "false", "yes",  "no",  "on", "off",
                                        "y",    "n",     "null", "nan", "inf"};
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end();
}

/// Returns true if a reader parses the unquoted text as the same text.
bool needs_no_quotes(const YamlNode& node) {
  const std::string& text = node.text;
  if (text.empty() || !std::all_of(text.begin(), text.end(), is_word_character)) return false;
  if (text.starts_with("---") || text.starts_with("...") || text == "-") return false;
  if (node.plain) return true;
  const char first = text.front();
  return (std::isalpha(static_cast<unsigned char>(first)) || first == '_' || first == '/') &&
         !is_reserved(text);
}

void emit_text(YAML::Emitter& out, const YamlNode& node) {
  if (!is_text(node.text)) {
    std::string shown = node.text;
    std::ranges::replace_if(
        shown, [](unsigned char c) { return c >= 0x80; }, '?');
    throw ConfigError(fmt::format(
        "'{}' is no UTF-8, which run.yaml cannot hold; rename the file or folder", shown));
  }
  if (!needs_no_quotes(node)) out << YAML::DoubleQuoted;
  out << node.text;
}

void emit(YAML::Emitter& out, const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      out << YAML::Null;
      break;
    case YamlNode::Kind::kScalar:
      emit_text(out, node);
      break;
    case YamlNode::Kind::kList: {
      const bool flat = std::all_of(node.entries.begin(), node.entries.end(), [](const auto& e) {
        return e.value->kind == YamlNode::Kind::kScalar || e.value->kind == YamlNode::Kind::kNull;
      });
      out << (flat ? YAML::Flow : YAML::Block) << YAML::BeginSeq;
      for (const auto& entry : node.entries) emit(out, *entry.value);
      out << YAML::EndSeq;
      break;
    }
    case YamlNode::Kind::kMap:
      out << YAML::Block << YAML::BeginMap;
      for (const auto& entry : node.entries) {
        YamlNode key;
        key.text = entry.key;
        key.plain = false;
        out << YAML::Key;
        emit_text(out, key);
        out << YAML::Value;
        emit(out, *entry.value);
      }
      out << YAML::EndMap;
      break;
  }
}

}  // namespace

std::string describe_position(const YamlOrigin& origin, int line, int column) {
  if (origin.is_override) return origin.name;
  return fmt::format("{}:{}:{}", origin.name, line, column);
}

std::string join_path(const std::string& head, const std::string& tail) {
  return head.empty() || tail.empty() ? head + tail : head + "." + tail;
}

std::string path_of(const YamlNode& node) {
  std::string path;
  const YamlNode* at = &node;
  for (; at->parent; at = at->parent) path = join_path(step_of(*at), path);
  return join_path(at->origin->path, path);
}

std::string place_of(const YamlNode& node) {
  if (!node.origin->is_program) return describe_position(*node.origin, node.line, node.column);
  const std::string path = path_of(node);
  return path.empty() ? node.origin->name : fmt::format("{}: {}", node.origin->name, path);
}

std::unique_ptr<YamlNode> make_scalar(std::string text, bool plain) {
  auto node = std::make_unique<YamlNode>();
  node->kind = YamlNode::Kind::kScalar;
  node->text = std::move(text);
  node->plain = plain;
  return node;
}

std::unique_ptr<YamlNode> clone(const YamlNode& node) {
  auto copy = std::make_unique<YamlNode>();
  copy->kind = node.kind;
  copy->plain = node.plain;
  copy->line = node.line;
  copy->column = node.column;
  copy->origin = node.origin;
  copy->text = node.text;
  for (const auto& entry : node.entries) {
    copy->add(entry.key, clone(*entry.value));
    copy->entries.back().line = entry.line;
    copy->entries.back().column = entry.column;
  }
  return copy;
}

std::string write_yaml(const YamlNode& node) {
  YAML::Emitter out;
  out.SetNullFormat(YAML::LowerNull);
  emit(out, node);
  return std::string(out.c_str(), out.size()) + "\n";
}

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
  if (YamlNode::Entry* entry = root_->find(key)) {
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

void YamlDocument::set_strings(std::string_view key, std::span<const std::string> items) {
  auto list = std::make_unique<YamlNode>();
  list->kind = YamlNode::Kind::kList;
  for (const std::string& item : items) list->add("", make_scalar(item, false));
  set_node(key, std::move(list));
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

}  // namespace hypotrack::detail::internal
