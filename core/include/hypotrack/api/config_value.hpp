#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/export.hpp"

namespace hypotrack {

/// A value of a document that a program makes: a map, list, text, number, bool or null.
///
///   const auto scene = ConfigValue::map({
///       {"models", ConfigValue::list({ConfigValue::map({{"type", "rigid_box"}})})},
///       {"tracker", "@trackers/rigid"},
///   });
///   hypotrack::Session session(scene.document("my scene"));
class HYPOTRACK_API ConfigValue {
 public:
  using Map = std::vector<std::pair<std::string, ConfigValue>>;
  using List = std::vector<ConfigValue>;

  ConfigValue();  ///< null
  ConfigValue(bool value);
  ConfigValue(double value);
  template <std::integral T>
  requires(!std::same_as<T, bool>) ConfigValue(T value)
      : ConfigValue(plain(std::to_string(value))) {}
  ConfigValue(std::string_view text);
  ConfigValue(const char* text) : ConfigValue(std::string_view(text)) {}
  ConfigValue(const std::string& text) : ConfigValue(std::string_view(text)) {}
  ConfigValue(const std::filesystem::path& path) : ConfigValue(path.native()) {}
  ConfigValue(const ConfigValue&);
  ConfigValue(ConfigValue&&) noexcept;
  ConfigValue& operator=(ConfigValue) noexcept;
  ~ConfigValue();

  /// Makes a map with these keys in this order. Throws ConfigError if two are equal.
  static ConfigValue map(const Map& entries);
  static ConfigValue list(const List& items);

  /// Returns the document with this value. `name` stands before the key path in messages:
  /// `my scene: models.0.type`. Relative paths refer to `directory`, or to the working directory if
  /// it is empty. Throws ConfigError on text that is not UTF-8 and beyond ConfigNode's limits.
  ConfigNode document(std::string name, const std::filesystem::path& directory = {}) const;

 private:
  explicit ConfigValue(std::unique_ptr<detail::YamlNode> node);
  static ConfigValue plain(std::string text);

  std::unique_ptr<detail::YamlNode> node_;
};

}  // namespace hypotrack
