#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/config.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack::synthetic {

/// Named postures: maps of joint angles to degrees, where `*` in a name is any text and later
/// entries replace earlier ones; the angles not named are at rest, and so are all in `rest`.
class Gestures {
 public:
  /// `own` are the scene's, `file` holds more as the only content of a YAML file; own ones come
  /// first where both have a name. Throws ConfigError with file:line:column.
  Gestures(ConfigNode own, const std::filesystem::path& file);

  /// The parameters (pose included, at rest) of a model in the gesture that `name` names.
  std::vector<double> parameters(const ConfigNode& name, const Scene::Item& item) const;

 private:
  ConfigNode find(const ConfigNode& name) const;
  ConfigNode own_, shared_;
};

}  // namespace hypotrack::synthetic
