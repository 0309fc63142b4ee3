#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/yaml_node.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// Replaces references to other files, and remembers the files that it read.
///
/// `@FILE.yaml` becomes the value at the same path in the scene FILE, `@FILE.yaml#key.path` the
/// value at that path. FILE is relative to the folder of the text. A copied value keeps its origin,
/// so that its relative paths still refer to FILE's folder.
class HYPOTRACK_API Parts {
 public:
  /// `file` is the file of the scene whose references are replaced; others may not refer to it.
  explicit Parts(const std::filesystem::path& file = {});
  ~Parts();
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  /// Replaces the references in `value`, which stands at `path`, recursively. Throws ConfigError.
  void take(std::unique_ptr<YamlNode>& value, std::vector<std::string>& path);

  /// Returns what a file has, its references replaced. Throws ConfigError, also if the file refers
  /// to one that is being read.
  const YamlNode& document(const std::filesystem::path& file);

 private:
  std::unique_ptr<YamlNode> part(const std::filesystem::path& file,
                                 const std::vector<std::string>& path, std::size_t level);

  /// Documents with their references replaced; null while one is being read.
  std::map<std::filesystem::path, std::unique_ptr<YamlNode>> documents_;
  std::size_t values_ = 0;
};

/// Replaces the references in `value`, which stands at `path`. Throws ConfigError.
void take_parts(std::unique_ptr<YamlNode>& value, std::vector<std::string> path);

}  // namespace hypotrack::detail
