#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::app {

/// What a model has: its degrees of freedom, the numbers of its state, landmarks, and shapes.
struct ModelInfo {
  int degrees_of_freedom = 0;
  std::vector<std::string> state, landmarks, shape;
};

/// Makes a model and describes it. `settings` are its parameters, as for --set: `file=lamp.urdf`.
/// Throws ConfigError, for example if it needs a file that is not given.
ModelInfo describe_model(PluginLoader& plugins, std::string_view name,
                         const std::vector<std::string>& settings);

/// Formats a description as lines of at most 100 characters.
std::string format_model(const ModelInfo& info);

/// Returns a description as text of the documentation.
std::string format_model_markdown(const ModelInfo& info);

}  // namespace hypotrack::app
