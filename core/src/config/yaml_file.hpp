#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "config/yaml_node.hpp"

namespace hypotrack::detail {

/// Parses a YAML document; an empty one becomes an empty map, so that readers report missing keys.
/// Its relative paths refer to `directory`, or to the working directory if that is empty. Throws
/// ConfigError.
std::unique_ptr<YamlNode> read_document(std::string_view text, std::string name,
                                        const std::filesystem::path& directory);

/// Reads a YAML file as read_document() does. Throws ConfigError, also if it cannot read the file.
std::unique_ptr<YamlNode> read_yaml_file(const std::filesystem::path& file);

}  // namespace hypotrack::detail
