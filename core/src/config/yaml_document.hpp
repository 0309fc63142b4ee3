#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack::detail {

struct YamlNode;

/// A YAML map that is put together to be written: what a run was made with, a scene for a
/// recording. Strings stay strings and numbers keep every digit on the way through.
class HYPOTRACK_API YamlDocument {
 public:
  /// From the text of a map; an empty text is an empty map. Throws ConfigError.
  explicit YamlDocument(std::string_view text = {});
  ~YamlDocument();
  YamlDocument(YamlDocument&&) noexcept;
  YamlDocument& operator=(YamlDocument&&) noexcept;

  /// Sets a key, in the place that it has or else at the end.
  void set(std::string_view key, const YamlDocument& value);
  /// Sets a key to a string, quoted where it could be taken for something else.
  void set_string(std::string_view key, std::string_view value);
  /// Sets a key to what `value` means as YAML: a number, for example.
  void set_plain(std::string_view key, std::string_view value);
  /// Sets a key to a list of maps.
  void set_list(std::string_view key, std::span<const YamlDocument> items);

  std::string text() const;

 private:
  void set_node(std::string_view key, std::unique_ptr<YamlNode> value);
  std::unique_ptr<YamlNode> root_;
};

}  // namespace hypotrack::detail
