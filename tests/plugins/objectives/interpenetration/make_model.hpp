#pragma once

#include <memory>
#include <string>

#include "hypotrack/plugin/model.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::interpenetration {

/// Makes the model that a part of a scene describes.
inline std::shared_ptr<const Model> make_model(const std::string& yaml) {
  PluginLoader plugins;
  return plugins.make<Model>(ConfigNode::parse(yaml, "scene.yaml"));
}

}  // namespace hypotrack::interpenetration
