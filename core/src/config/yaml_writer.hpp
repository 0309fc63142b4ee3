#pragma once

#include <string>

#include "config/yaml_node.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// A node as YAML text that read_yaml reads back to an equal node (positions apart).
HYPOTRACK_API std::string write_yaml(const YamlNode& node);

/// A new scalar; text that could be taken for a number, bool or null stays text unless `plain`.
HYPOTRACK_API std::unique_ptr<YamlNode> make_scalar(std::string text, bool plain);

/// A copy with its own children, without a parent.
std::unique_ptr<YamlNode> clone(const YamlNode& node);

}  // namespace hypotrack::detail
