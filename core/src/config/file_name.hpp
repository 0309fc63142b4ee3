#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/exported.hpp"
#include "config/yaml.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// A reference to a file, `"@trackers/recommended"` or `"@FILE.yaml"`, and where it is written.
struct FileName {
  std::string text;  ///< without the @
  std::filesystem::path directory;
  std::string where;

  /// Returns true for a path to a YAML file, which does not name one that comes with hypotrack.
  bool is_path() const { return text.ends_with(".yaml") || text.ends_with(".yml"); }
};

/// Returns the reference that a value is: a text that begins with one @ and names no key.
std::optional<FileName> file_name_in(const YamlNode& value);

/// Returns the file of a reference: in the folder of the document, or among the configurations that
/// come with hypotrack. `kind` is the word for it, and its folder there has the plural's name.
/// Throws ConfigError if there is no such file.
std::filesystem::path find_file(const FileName& name, std::string_view kind);

}  // namespace internal
}  // namespace hypotrack::detail
