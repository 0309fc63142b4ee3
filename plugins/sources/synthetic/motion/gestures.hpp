#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack::synthetic {

/// Named postures: maps of joint angles to degrees. `*` in a name matches any text, and later
/// entries replace earlier ones. Angles not named are at rest. The gesture `rest` has all angles at
/// rest.
class Gestures {
 public:
  /// `own` are the scene's gestures; `file` is a YAML file of more. The scene's win where both have
  /// a name. Throws ConfigError with file:line:column.
  Gestures(ConfigNode own, const std::filesystem::path& file);

  /// Returns the parameters (pose included, at rest) of a model in a gesture. `said` is the node
  /// that names it, for messages.
  std::vector<double> parameters(const std::string& name, const ConfigNode& said,
                                 const Scene::Item& item) const;

  /// Returns the names of all gestures, the scene's first.
  std::vector<std::string> names() const;

 private:
  ConfigNode find(const std::string& name, const ConfigNode& said) const;
  ConfigNode own_, shared_;
};

}  // namespace hypotrack::synthetic
