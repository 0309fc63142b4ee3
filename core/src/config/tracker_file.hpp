#pragma once

#include <span>
#include <string>
#include <vector>

#include "config/includes.hpp"
#include "config/yaml_node.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// Adds the keys of a tracker file to a document that names one, and returns the overrides that are
/// left to apply.
///
/// A document names one as `tracker: "@trackers/recommended"`, or by `from` in the map `tracker`;
/// the last override that does so wins. A tracker file is a map with the objective, the optimizer
/// and any other key of a scene but models and source. `@trackers/recommended` is
/// trackers/recommended.yaml in the document's folder, or among the configurations that come with
/// hypotrack; `@FILE.yaml` is a path, and one of a scene is left to Includes::resolve(). Keys of
/// the document stay, and maps without a `type` are joined. An override replaces all keys of a
/// tracker. Throws ConfigError.
HYPOTRACK_API std::vector<std::string> take_tracker(YamlNode& document,
                                                    std::span<const std::string> overrides,
                                                    Includes& includes);

}  // namespace hypotrack::detail
