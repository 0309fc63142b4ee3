#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/exported.hpp"

// YAML documents: as trees that know where their values are written, and as maps to be written.

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// The file or `--set` override that nodes come from.
struct YamlOrigin {
  std::string name;
  std::filesystem::path directory;  ///< absolute; relative paths refer to it
  bool is_override = false;         ///< has no line numbers; the name is the whole position
  bool is_program = false;          ///< has no line numbers; a program made the document
  std::string path = {};            ///< of the root, if it is a part of another document
};

/// A value of a YAML document. Parents own their children; the root owns the document.
struct YamlNode {
  enum class Kind { kNull, kScalar, kList, kMap };

  struct Entry {
    std::string key;  ///< empty in lists
    int line = 1;     ///< of the key
    int column = 1;
    std::unique_ptr<YamlNode> value;
  };

  Kind kind = Kind::kNull;
  bool plain = true;  ///< written without quotes
  int line = 1;       ///< from 1
  int column = 1;     ///< from 1, in characters
  const YamlNode* parent = nullptr;
  std::shared_ptr<const YamlOrigin> origin;
  std::string text = "null";  ///< of scalars
  std::vector<Entry> entries;

  const Entry* find(std::string_view key) const {
    for (const Entry& entry : entries) {
      if (kind == Kind::kMap && entry.key == key) return &entry;
    }
    return nullptr;
  }
  Entry* find(std::string_view key) { return const_cast<Entry*>(std::as_const(*this).find(key)); }

  /// Appends a child and returns it.
  YamlNode& add(std::string key, std::unique_ptr<YamlNode> value) {
    value->parent = this;
    entries.push_back({std::move(key), value->line, value->column, std::move(value)});
    return *entries.back().value;
  }
};

inline constexpr std::size_t kMaxYamlBytes = std::size_t{8} << 20;
inline constexpr std::size_t kMaxYamlNodes = 1'000'000;
inline constexpr std::size_t kMaxYamlDepth = 64;

/// Returns `scene.yaml:12:5`, or only the name for an override.
std::string describe_position(const YamlOrigin& origin, int line, int column);

/// Joins two key paths, either of which may be empty.
std::string join_path(const std::string& head, const std::string& tail);

/// Returns the keys that lead to a node from its root, `models.0.type`, behind those of its origin.
std::string path_of(const YamlNode& node);

/// Returns where a node was written: describe_position(), or `NAME: key.path` in a document that a
/// program made.
std::string place_of(const YamlNode& node);

/// Makes a scalar. Unless `plain`, text that looks like a number, bool or null stays text.
std::unique_ptr<YamlNode> make_scalar(std::string text, bool plain);

/// Copies a node with all its children; the copy has no parent.
std::unique_ptr<YamlNode> clone(const YamlNode& node);

/// Parses one YAML document; an empty text is a null node. Throws ConfigError, with the position,
/// on everything that ConfigNode::load refuses.
std::unique_ptr<YamlNode> read_yaml(std::string_view text,
                                    const std::shared_ptr<const YamlOrigin>& origin);

/// Parses a YAML document; an empty one becomes an empty map, so that readers report missing keys.
/// Its relative paths refer to `directory`, or to the working directory if that is empty. Throws
/// ConfigError.
std::unique_ptr<YamlNode> read_document(std::string_view text, std::string name,
                                        const std::filesystem::path& directory);

/// Reads a YAML file as read_document() does. Throws ConfigError, also if it cannot read the file.
std::unique_ptr<YamlNode> read_yaml_file(const std::filesystem::path& file);

/// Writes a node as YAML text that read_yaml() reads back to an equal node, except positions.
std::string write_yaml(const YamlNode& node);

/// A YAML map that a program builds and writes, such as a run's protocol or a recording's scene.
/// Strings stay strings and numbers keep every digit.
class YamlDocument {
 public:
  /// Parses the text of a map; an empty text is an empty map. Throws ConfigError.
  explicit YamlDocument(std::string_view text = {});
  ~YamlDocument();
  YamlDocument(YamlDocument&&) noexcept;
  YamlDocument& operator=(YamlDocument&&) noexcept;

  /// Sets a key; an existing key keeps its place, a new one comes last.
  void set(std::string_view key, const YamlDocument& value);
  /// Sets a key to a string; quotes it if YAML could read it as another type.
  void set_string(std::string_view key, std::string_view value);
  /// Sets a key to `value` as unquoted YAML, for example a number.
  void set_plain(std::string_view key, std::string_view value);
  /// Sets a key to a list of strings, each as set_string() writes it.
  void set_strings(std::string_view key, std::span<const std::string> items);
  /// Sets a key to a list of maps.
  void set_list(std::string_view key, std::span<const YamlDocument> items);

  std::string text() const;

 private:
  void set_node(std::string_view key, std::unique_ptr<YamlNode> value);
  std::unique_ptr<YamlNode> root_;
};

/// Parses a TOML document, or sections of `key = value` lines, to the tree of the same YAML. Throws
/// ConfigError with the position, also on dates and times.
std::unique_ptr<YamlNode> read_toml(std::string_view text,
                                    const std::shared_ptr<const YamlOrigin>& origin);

}  // namespace internal
}  // namespace hypotrack::detail
