#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "config/yaml_node.hpp"

namespace hypotrack::detail {

/// Replaces texts `@FILE.yaml`, in a value at `path` of a scene, by what the scene FILE has at the
/// same path as the text, and `@FILE.yaml#key.path` by what it has at that one, its own such texts
/// replaced. FILE refers to the folder that the text was written in; what is taken keeps its
/// origin, so that its relative paths still refer to the folder of FILE. `file` is the scene's own,
/// if `value` is one. Throws ConfigError.
void take_parts(std::unique_ptr<YamlNode>& value, std::vector<std::string> path,
                const std::filesystem::path& file = {});

}  // namespace hypotrack::detail
