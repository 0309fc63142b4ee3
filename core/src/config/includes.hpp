#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "config/yaml.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Replaces includes of other files by their values, and remembers the files that it read.
///
/// `@FILE.yaml` becomes the value at the same path in the scene FILE, `@FILE.yaml#key.path` the
/// value at that path. FILE is relative to the folder of the text. A copied value keeps its origin,
/// so that its relative paths still refer to FILE's folder.
class Includes {
 public:
  /// `file` is the file of the scene whose includes are replaced; others may not include it.
  explicit Includes(const std::filesystem::path& file = {});
  ~Includes();
  Includes(const Includes&) = delete;
  Includes& operator=(const Includes&) = delete;

  /// Replaces the includes in `value`, which stands at `path`, recursively. Throws ConfigError.
  void resolve(std::unique_ptr<YamlNode>& value, std::vector<std::string>& path);

  /// Moves the former keys of a document and keeps the notes on them.
  void move_former(YamlNode& document);
  /// Returns an override with its keys of today (former_keys.hpp), and keeps the note on it.
  std::optional<std::string> override_today(YamlNode& document, const std::string& assignment);
  const std::vector<std::string>& notes() const { return notes_; }

  /// Returns what a file has, its includes replaced and its former keys moved. Throws ConfigError,
  /// also if the file includes one that is being read.
  const YamlNode& document(const std::filesystem::path& file);

 private:
  std::unique_ptr<YamlNode> included(const std::filesystem::path& file,
                                     const std::vector<std::string>& path, std::size_t level);

  /// Documents with their includes replaced; null while one is being read.
  std::map<std::filesystem::path, std::unique_ptr<YamlNode>> documents_;
  std::size_t values_ = 0;
  std::vector<std::string> notes_;
};

/// Replaces the includes in `value`, which stands at `path`. Throws ConfigError.
void resolve_includes(std::unique_ptr<YamlNode>& value, std::vector<std::string> path);

/// Adds the keys of a tracker file to a document that names one, and returns the overrides that are
/// left to apply.
///
/// A document names one as `tracker: "@trackers/recommended"`; the last override that does so wins.
/// A tracker file is a map with the objective, the optimizer and any other key of a scene but
/// models and source. `@trackers/recommended` is trackers/recommended.yaml in the document's
/// folder, or among the configurations that come with hypotrack; `@FILE.yaml` is a path, and one of
/// a scene is left to Includes::resolve(). Keys of the document stay, and maps without a `type` are
/// joined. An override replaces all keys of a tracker. Throws ConfigError.
std::vector<std::string> take_tracker(YamlNode& document, std::span<const std::string> overrides,
                                      Includes& includes);

/// Reads a study and, if it `extends` another, adds to that one.
///
/// Maps are joined key by key. Any other value takes the place of the other study's, and so does a
/// map with a `type`. Values keep their origin. The folder of changes (`directory`) is that of the
/// study that is extended, unless one of them gives another. Throws ConfigError.
std::unique_ptr<YamlNode> read_study_file(const std::filesystem::path& file);

}  // namespace internal
}  // namespace hypotrack::detail
