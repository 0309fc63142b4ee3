#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "config/yaml_node.hpp"

namespace hypotrack::detail {

/// Replaces the references to other scenes in `value`, which stands at `path`, recursively.
/// `@FILE.yaml` becomes the value at the same path in the scene FILE, `@FILE.yaml#key.path` the
/// value at that path. FILE is relative to the folder of the text. A copied value keeps its origin,
/// so that its relative paths still refer to FILE's folder. `file` is the scene's own file if
/// `value` is a whole scene. Throws ConfigError.
void take_parts(std::unique_ptr<YamlNode>& value, std::vector<std::string> path,
                const std::filesystem::path& file = {});

}  // namespace hypotrack::detail
