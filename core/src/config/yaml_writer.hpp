#pragma once

#include <string>

#include "config/yaml_node.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// Writes a node as YAML text that read_yaml() reads back to an equal node, except positions.
HYPOTRACK_API std::string write_yaml(const YamlNode& node);

/// Makes a scalar. Unless `plain`, text that looks like a number, bool or null stays text.
HYPOTRACK_API std::unique_ptr<YamlNode> make_scalar(std::string text, bool plain);

/// Copies a node with all its children; the copy has no parent.
std::unique_ptr<YamlNode> clone(const YamlNode& node);

}  // namespace hypotrack::detail
