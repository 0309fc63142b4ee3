#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace hypotrack::detail {

/// The file or `--set` override that nodes come from.
struct YamlOrigin {
  std::string name;
  std::filesystem::path directory;  ///< absolute; relative paths refer to it
  bool is_override = false;         ///< has no line numbers; the name is the whole position
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

}  // namespace hypotrack::detail
