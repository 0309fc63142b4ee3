#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <optional>
#include <sstream>
#include <unordered_set>
#include <utility>

#include "config/yaml.hpp"
#include "config/yaml_text.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::detail::internal {
namespace {

/// Returns true if a quoted scalar at the start of `text` has its closing quote.
bool is_closed(std::string_view text) {
  const char quote = text.front();
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text[i] == quote) {
      return true;
    }
  }
  return false;
}

/// Builds the tree from the parser's events instead of YAML::Node. This keeps the positions of keys
/// and detects duplicate keys and aliases. Every limit applies before memory is allocated and
/// before the parser recurses further.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const YamlText& text, std::shared_ptr<const YamlOrigin> origin)
      : text_(text), origin_(std::move(origin)) {}

  /// Returns the document. Throws if a map or list was a key.
  std::unique_ptr<YamlNode> take_root() {
    if (complex_key_) fail(*complex_key_, "a map or list cannot be a key; expected a word");
    return std::move(root_);
  }

  [[noreturn]] void fail(const YAML::Mark& mark, std::string_view problem) const {
    const auto at = text_.position(mark.line, mark.column);
    throw ConfigError(
        fmt::format("{}: {}", describe_position(*origin_, at.line, at.column), problem));
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) {
      fail(mark, "something follows the end of the document; expected one YAML document per file");
    }
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    if (inside_key_ > 0) return;
    if (awaits_key()) fail(mark, "null cannot be a key; expected a word");
    auto node = make(YamlNode::Kind::kNull, mark);
    // The parser reports the position after the missing value, which does not help a reader.
    if (key_) {
      node->line = key_->position.line;
      node->column = key_->position.column;
    }
    attach(std::move(node));
  }

  void OnAnchor(const YAML::Mark& mark, const std::string& name) override {
    fail(mark, fmt::format("anchor '&{}': anchors are not supported; repeat the value", name));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail(mark, "aliases are not supported; repeat the value");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& value) override {
    check_start(mark, tag);
    if (inside_key_ > 0) return;
    if (awaits_key()) return take_key(mark, value);
    auto node = make(YamlNode::Kind::kScalar, mark);
    node->text = value;
    node->plain = tag == kPlainTag;
    attach(std::move(node));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::kList, mark, tag);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::kMap, mark, tag);
  }
  void OnMapEnd() override { close(); }

 private:
  static constexpr std::string_view kPlainTag = "?";   // yaml-cpp's tag for unquoted scalars
  static constexpr std::string_view kQuotedTag = "!";  // yaml-cpp's tag for quoted scalars

  struct Key {
    std::string name;
    YamlText::Position position{1, 1};
  };
  struct Open {
    YamlNode* node;
    std::unordered_set<std::string> keys;
  };

  bool awaits_key() const {
    return !open_.empty() && open_.back().node->kind == YamlNode::Kind::kMap && !key_;
  }

  void check_start(const YAML::Mark& mark, const std::string& tag) const {
    // yaml-cpp 0.7.0 accepts the end of the file as a closing quote.
    const std::string_view rest = text_.from(mark.line, mark.column);
    if (tag == kQuotedTag && (rest.starts_with('\'') || rest.starts_with('"')) &&
        !is_closed(rest)) {
      fail(mark, "broken YAML: the quote that begins here is never closed");
    }
    if (tag.empty() || tag == kPlainTag || tag == kQuotedTag) return;
    fail(mark, fmt::format("tag '{}': tags are not supported; remove it", tag));
  }

  void take_key(const YAML::Mark& mark, const std::string& name) {
    if (name == "<<") fail(mark, "merge keys (<<) are not supported; repeat the values");
    if (!open_.back().keys.insert(name).second) {
      const auto* first = open_.back().node->find(name);
      fail(mark, fmt::format("duplicate key '{}'; it was first given in line {}", name,
                             first ? first->line : 0));
    }
    key_ = Key{name, text_.position(mark.line, mark.column)};
  }

  std::unique_ptr<YamlNode> make(YamlNode::Kind kind, const YAML::Mark& mark) {
    if (++nodes_ > kMaxYamlNodes) {
      fail(mark, fmt::format("more than {} values, which no scene needs", kMaxYamlNodes));
    }
    auto node = std::make_unique<YamlNode>();
    const auto at = text_.position(mark.line, mark.column);
    node->kind = kind;
    node->line = at.line;
    node->column = at.column;
    node->origin = origin_;
    return node;
  }

  YamlNode* attach(std::unique_ptr<YamlNode> node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return root_.get();
    }
    YamlNode& parent = *open_.back().node;
    YamlNode& child = parent.add(key_ ? std::move(key_->name) : std::string(), std::move(node));
    if (key_) {
      parent.entries.back().line = key_->position.line;
      parent.entries.back().column = key_->position.column;
      key_.reset();
    }
    return &child;
  }

  void open(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag) {
    check_start(mark, tag);
    if (open_.size() + inside_key_ >= kMaxYamlDepth) {
      fail(mark, fmt::format("nested deeper than {} levels", kMaxYamlDepth));
    }
    if (inside_key_ > 0 || awaits_key()) {
      if (!complex_key_) complex_key_ = mark;
      ++inside_key_;
      return;
    }
    YamlNode* node = attach(make(kind, mark));
    open_.push_back({node, {}});
  }

  void close() {
    if (inside_key_ == 0) return open_.pop_back();
    if (--inside_key_ == 0) key_ = Key{};
  }

  const YamlText& text_;
  std::shared_ptr<const YamlOrigin> origin_;
  std::unique_ptr<YamlNode> root_;
  std::vector<Open> open_;
  std::optional<Key> key_;  ///< of the innermost map, waiting for its value
  /// Position of a map or list used as a key. This is usually an unclosed bracket, for which the
  /// parser has a better message later. So the key is skipped, counting its levels, and rejected at
  /// the end.
  std::optional<YAML::Mark> complex_key_;
  std::size_t inside_key_ = 0;
  std::size_t nodes_ = 0;
  int documents_ = 0;
};

/// Returns a hint for parser errors whose message does not say what to do.
const char* hint_about(const YamlText& text, const YAML::Mark& mark) {
  if (text.from(mark.line, mark.column).starts_with('@'))
    return "; a text that begins with @ needs quotes";
  const std::string_view line = text.from(mark.line, 0);
  const std::string_view indentation = line.substr(0, line.find_first_not_of(" \t"));
  if (indentation.find('\t') != std::string_view::npos)
    return "; this line is indented with a tab, YAML takes spaces only";
  return "";
}

}  // namespace

std::unique_ptr<YamlNode> read_yaml(std::string_view text,
                                    const std::shared_ptr<const YamlOrigin>& origin) {
  const YamlText checked(text, *origin);
  TreeBuilder builder(checked, origin);
  try {
    std::istringstream stream{std::string(checked.text())};
    YAML::Parser parser(stream);
    // Call it at most twice: yaml-cpp 0.7.0 can find another document at the same place forever.
    if (parser.HandleNextDocument(builder)) parser.HandleNextDocument(builder);
  } catch (const YAML::Exception& e) {
    builder.fail(e.mark, fmt::format("broken YAML: {}{}", e.msg, hint_about(checked, e.mark)));
  }
  auto root = builder.take_root();
  if (!root) {
    root = std::make_unique<YamlNode>();
    root->origin = origin;
  }
  return root;
}

std::unique_ptr<YamlNode> read_document(std::string_view text, std::string name,
                                        const std::filesystem::path& directory) {
  auto origin = std::make_shared<YamlOrigin>();
  origin->name = std::move(name);
  origin->directory =
      std::filesystem::absolute(directory.empty() ? std::filesystem::current_path() : directory);
  auto root = read_yaml(text, origin);
  if (root->kind == YamlNode::Kind::kNull) root->kind = YamlNode::Kind::kMap;
  return root;
}

std::unique_ptr<YamlNode> read_yaml_file(const std::filesystem::path& file) {
  const std::string text = read_text_file(file);
  return read_document(text, file.string(), std::filesystem::absolute(file).parent_path());
}

}  // namespace hypotrack::detail::internal
