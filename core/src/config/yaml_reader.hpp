#pragma once

#include <memory>
#include <string_view>

#include "config/yaml_node.hpp"

namespace hypotrack::detail {

/// Reads one YAML document. Throws ConfigError, with the position, on everything that
/// ConfigNode::load refuses. An empty text is a null node.
std::unique_ptr<YamlNode> read_yaml(std::string_view text,
                                    const std::shared_ptr<const YamlOrigin>& origin);

}  // namespace hypotrack::detail
