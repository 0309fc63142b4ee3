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

  /// The parameters (pose included, at rest) of a model in a gesture. `said` is the node that names
  /// it, for messages.
  std::vector<double> parameters(const std::string& name, const ConfigNode& said,
                                 const Scene::Item& item) const;

  /// All gestures that are written down, own ones first.
  std::vector<std::string> names() const;

 private:
  ConfigNode find(const std::string& name, const ConfigNode& said) const;
  ConfigNode own_, shared_;
};

}  // namespace hypotrack::synthetic
