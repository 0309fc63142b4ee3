#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hypotrack/api/export.hpp"

namespace hypotrack {

namespace detail {
inline namespace [[gnu::visibility("default")]] internal {  // for hypotrack's own programs
struct YamlNode;
}
}  // namespace detail

/// A read-only YAML node that remembers where it was written. Cheap to copy. Plugins describe their
/// parameters with `visit` (params.hpp) and rarely need it, except to pass on a nested plugin.
class HYPOTRACK_API ConfigNode {
 public:
  /// Creates an undefined node: no map, list or scalar.
  ConfigNode();

  /// Reads a YAML file; an empty file is an empty map. Throws ConfigError on unreadable files,
  /// broken YAML, duplicate keys, aliases, tags and several documents. The limits are 8 MiB, a
  /// million values and 64 levels of nesting.
  static ConfigNode load(const std::filesystem::path& file);

  /// Reads a scene file, replaces its references to other scenes and applies the overrides.
  /// `@FILE.yaml` stands for the value at the same path in the scene FILE, `@FILE.yaml#key.path`
  /// for the value at that path.
  /// `tracker: "@trackers/NAME"` adds the keys of a tracker file (docs/reference/scenes.md).
  /// An override is `key.path=value`, with list items by index: `models.0.type=rigid_box`. The
  /// value is YAML; its relative paths refer to the working directory. Absent keys on the way are
  /// created, and so is the item after a list's last one.
  /// Throws ConfigError as load() does, and on overrides that do not parse or references that do
  /// not exist.
  /// Keys that have another place since version 0.2 are moved there; `notes` then gets a line.
  static ConfigNode load_scene(const std::filesystem::path& file,
                               std::span<const std::string> overrides = {},
                               std::vector<std::string>* notes = nullptr);

  /// Returns this document as load_scene() returns a file: with its tracker, its references and the
  /// overrides. Throws ConfigError.
  ConfigNode as_scene(std::span<const std::string> overrides = {},
                      std::vector<std::string>* notes = nullptr) const;

  /// Reads a study file as load() does, joined with the study that it `extends`. Throws
  /// ConfigError.
  static ConfigNode load_study(const std::filesystem::path& file);

  /// Parses YAML text under the rules of load(). `name` replaces the file name in messages.
  /// Relative paths refer to `directory`, or to the working directory if it is empty.
  static ConfigNode parse(std::string_view text, std::string name,
                          std::filesystem::path directory = {});

  /// Parses TOML text; the result is that of the same YAML. Throws ConfigError, also on dates.
  static ConfigNode parse_toml(std::string_view text, std::string name);

  /// Makes a map of nodes that remember where they were written. Undefined nodes are left out. The
  /// map has the position and path of its first value.
  static ConfigNode map_of(std::span<const std::pair<std::string, ConfigNode>> entries);

  bool defined() const;
  bool is_map() const;
  bool is_list() const;
  /// Returns true for a value without structure, `null` included.
  bool is_scalar() const;
  /// Returns true for `null`, `~` or a key without a value.
  bool is_null() const;

  /// Returns the number of entries of a map or list, otherwise 0.
  std::size_t size() const;
  /// Returns the keys of a map in the order of the file.
  std::vector<std::string> keys() const;
  /// Returns the value of a key, or an undefined node if this is not a map or lacks the key. An
  /// undefined node still knows its path(), and its where() is that of its parent.
  ConfigNode get(std::string_view key) const;
  /// Returns an item of a list, or an undefined node if there is none.
  ConfigNode at(std::size_t index) const;
  /// Returns the text of a scalar.
  const std::string& scalar() const;
  /// Returns true for a scalar without quotes, which may be read as a number, bool or null.
  bool is_plain() const;

  /// Returns where the node was written: `scene.yaml:12:5` (line and column from 1), the override
  /// it comes from, `--set models.0.type=rigid_box`, or its place in a document that a program
  /// made: `my scene: models.0.type`.
  std::string where() const;
  /// Returns where a key of this map was written, or where() if there is no such key.
  std::string where_key(std::string_view key) const;
  /// Returns the keys that lead here from the root, `models.0.type`; empty at the root.
  std::string path() const;
  /// Returns this node at another path, for example as the default of a key that a document lacks.
  ConfigNode placed_at(std::string path) const;
  /// Returns the folder that relative paths in this node refer to.
  const std::filesystem::path& directory() const;
  /// Writes the node as YAML without comments: block style, lists of scalars on one line. Reading
  /// the text gives an equal node.
  std::string to_yaml() const;

 private:
  friend class ConfigValue;
  explicit ConfigNode(std::shared_ptr<const detail::YamlNode> node);
  ConfigNode missing(std::string_view step) const;

  std::shared_ptr<const detail::YamlNode> node_;  ///< owns the whole document
  std::optional<std::string> missing_;            ///< path of an absent node below `node_`
};

}  // namespace hypotrack
