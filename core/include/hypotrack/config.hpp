#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// A read-only node of a YAML file that remembers where it was written. Cheap to copy. Plugins that
/// describe their parameters with a `visit` (params.hpp) rarely need it; it carries nested plugins.
class HYPOTRACK_API ConfigNode {
 public:
  /// An undefined node: neither map, list nor scalar.
  ConfigNode();

  /// Reads a YAML file. Overrides are `key.path=value` (list items by index: `models.0.type=hand`);
  /// the value is YAML and relative paths in it are relative to the working directory.
  /// Throws ConfigError on unreadable files, broken YAML, duplicate keys, aliases, files over 8
  /// MiB, nesting over 64 levels and overrides that do not parse.
  static ConfigNode load(const std::filesystem::path& file,
                         std::span<const std::string> overrides = {});

  /// The same for a text; `name` takes the place of the file name in messages, and `directory` is
  /// what relative paths refer to (the working directory if empty).
  static ConfigNode parse(std::string_view text, std::string name,
                          std::filesystem::path directory = {});

  bool defined() const;
  bool is_map() const;
  bool is_list() const;
  bool is_scalar() const;

  /// Number of entries of a map or list, otherwise 0.
  std::size_t size() const;
  /// Keys of a map, in the order of the file.
  std::vector<std::string> keys() const;
  /// The value under a key; undefined if this is no map or has no such key.
  ConfigNode get(std::string_view key) const;
  /// Item of a list.
  ConfigNode at(std::size_t index) const;
  /// Text of a scalar.
  const std::string& scalar() const;
  /// Whether a scalar was written without quotes and so may be read as number, bool or null.
  bool is_plain() const;

  /// Where the node was written: `scene.yaml:12:5`.
  std::string where() const;
  /// The folder that relative paths in this node refer to.
  const std::filesystem::path& directory() const;
  /// The node as YAML text (block style), without comments.
  std::string to_yaml() const;

 private:
  struct Impl;
  explicit ConfigNode(std::shared_ptr<const Impl> impl);
  std::shared_ptr<const Impl> impl_;
};

}  // namespace hypotrack
