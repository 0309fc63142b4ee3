#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack::detail {

struct YamlNode;

/// A YAML map that a program builds and writes, such as a run's protocol or a recording's scene.
/// Strings stay strings and numbers keep every digit.
class HYPOTRACK_API YamlDocument {
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
  /// Sets a key to a list of maps.
  void set_list(std::string_view key, std::span<const YamlDocument> items);

  std::string text() const;

 private:
  void set_node(std::string_view key, std::unique_ptr<YamlNode> value);
  std::unique_ptr<YamlNode> root_;
};

}  // namespace hypotrack::detail
