#include <memory>
#include <string>
#include <vector>

#include "config/overrides.hpp"
#include "config/yaml.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

/// Returns the steps from a node's path to that of a node below it, or nothing if it is not below.
std::vector<std::string> steps_between(const std::string& outer, const std::string& inner) {
  const std::string head = outer.empty() ? "" : outer + ".";
  if (!inner.starts_with(head) || inner.size() == head.size()) return {};
  return detail::split_path(std::string_view(inner).substr(head.size()));
}

}  // namespace

PluginContext::PluginContext(ConfigNode config, const Scene* scene, PluginLoader& plugins,
                             std::vector<std::string> also_allowed,
                             std::shared_ptr<PluginNotes> notes, std::string who)
    : config_(std::move(config)),
      scene_(scene),
      plugins_(&plugins),
      also_allowed_(std::move(also_allowed)),
      notes_(std::move(notes)),
      who_(std::move(who)) {}

const Scene& PluginContext::scene() const {
  if (!scene_) {
    throw PluginError(config_.where() +
                      ": the plugin asks for the scene, which exists only once all models do");
  }
  return *scene_;
}

void PluginContext::record_nested(const ConfigNode& config, const std::string& resolved) {
  const auto steps = steps_between(config_.path(), config.path());
  if (steps.empty()) return;  // from elsewhere, so it is not a parameter of this plugin
  auto origin = std::make_shared<detail::YamlOrigin>();
  origin->name = config.where();
  const auto tree = detail::read_yaml(resolved_, origin);
  detail::assign(*tree, steps, detail::read_yaml(resolved, origin), origin->name);
  resolved_ = detail::write_yaml(*tree);
}

}  // namespace hypotrack
