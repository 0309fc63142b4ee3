#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "config/yaml_node.hpp"

namespace hypotrack::detail {

/// Reads a document and makes a map of an empty one, so that readers name the keys it lacks.
/// Relative paths in it refer to `directory`, the working directory if that is empty. Throws
/// ConfigError.
std::unique_ptr<YamlNode> read_document(std::string_view text, std::string name,
                                        const std::filesystem::path& directory);

/// The same for a file. Throws ConfigError, also where the file cannot be read.
std::unique_ptr<YamlNode> read_yaml_file(const std::filesystem::path& file);

}  // namespace hypotrack::detail
