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

namespace detail {
struct YamlNode;
}

/// A read-only node of a YAML file that remembers where it was written. Cheap to copy. Plugins that
/// describe their parameters with a `visit` (params.hpp) rarely need it; it carries nested plugins.
class HYPOTRACK_API ConfigNode {
 public:
  /// An undefined node: neither map, list nor scalar.
  ConfigNode();

  /// Reads a YAML file. Throws ConfigError on unreadable files, broken YAML, duplicate keys,
  /// aliases, tags, several documents, files over 8 MiB or a million values and nesting over 64
  /// levels. An empty file is an empty map.
  static ConfigNode load(const std::filesystem::path& file);

  /// Reads a scene: the same, and a text `@FILE.yaml` is what the scene FILE has at the same place,
  /// `@FILE.yaml#key.path` what it has there. Overrides are `key.path=value` (list items by index:
  /// `models.0.type=hand`); the value is YAML and relative paths in it are relative to the working
  /// directory. Absent keys on the way are created, and so is the item after a list's last one.
  /// Throws ConfigError also on overrides that do not parse and on parts that are not there.
  static ConfigNode load_scene(const std::filesystem::path& file,
                               std::span<const std::string> overrides = {});

  /// Reads a text as load() reads a file; `name` takes the place of the file name in messages, and
  /// `directory` is what relative paths refer to (the working directory if empty).
  static ConfigNode parse(std::string_view text, std::string name,
                          std::filesystem::path directory = {});

  bool defined() const;
  bool is_map() const;
  bool is_list() const;
  /// A value without further structure; `null` is one, too.
  bool is_scalar() const;
  /// `null`, `~` or nothing at all after a key.
  bool is_null() const;

  /// Number of entries of a map or list, otherwise 0.
  std::size_t size() const;
  /// Keys of a map, in the order of the file.
  std::vector<std::string> keys() const;
  /// The value under a key; undefined if this is no map or has no such key. An undefined node still
  /// says where() its parent is and what its path() would be.
  ConfigNode get(std::string_view key) const;
  /// Item of a list; undefined if there is none.
  ConfigNode at(std::size_t index) const;
  /// Text of a scalar.
  const std::string& scalar() const;
  /// Whether a scalar was written without quotes and so may be read as number, bool or null.
  bool is_plain() const;

  /// Where the node was written: `scene.yaml:12:5` (line and column from 1, as editors count), or
  /// the override it comes from: `--set models.0.type=hand`.
  std::string where() const;
  /// Where a key of this map was written; where() if there is no such key.
  std::string where_key(std::string_view key) const;
  /// The keys that lead here from the root, `models.0.type`; empty at the root.
  std::string path() const;
  /// The same value as if it were at another path: a default for a key that a document lacks.
  ConfigNode placed_at(std::string path) const;
  /// The folder that relative paths in this node refer to.
  const std::filesystem::path& directory() const;
  /// The node as YAML text, without comments: block style, lists of scalars on one line. Reading it
  /// gives the same node again.
  std::string to_yaml() const;

 private:
  explicit ConfigNode(std::shared_ptr<const detail::YamlNode> node);
  ConfigNode missing(std::string_view step) const;

  std::shared_ptr<const detail::YamlNode> node_;  ///< keeps the whole document alive
  std::optional<std::string> missing_;  ///< path below `node_` of a node that is not there
};

}  // namespace hypotrack
