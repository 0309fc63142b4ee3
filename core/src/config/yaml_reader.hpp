#pragma once

#include <memory>
#include <string_view>

#include "config/yaml_node.hpp"

namespace hypotrack::detail {

/// Parses one YAML document; an empty text is a null node. Throws ConfigError, with the position,
/// on everything that ConfigNode::load refuses.
std::unique_ptr<YamlNode> read_yaml(std::string_view text,
                                    const std::shared_ptr<const YamlOrigin>& origin);

}  // namespace hypotrack::detail
