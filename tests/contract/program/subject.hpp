#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "hypotrack/plugin.hpp"
#include "report.hpp"

namespace hypotrack::contract {

/// The plugin under test: a library, the parameters to make it with, and the scene that it finds
/// itself in (one right hand of 27 parameters, named `hand`).
struct Subject {
  std::string kind;
  std::filesystem::path library;
  std::filesystem::path config_file;  ///< parameters as in a scene; empty: the defaults
  std::string name;                   ///< from the library, once its descriptor has been checked
  bool needs_device = false;          ///< likewise: it has this capability
  std::unique_ptr<PluginLoader> loader;
  std::unique_ptr<Scene> scene;

  /// The parameters with the plugin's `type`.
  ConfigNode config() const;
  /// The same and one more line of YAML.
  ConfigNode config_with(const std::string& more) const;

  /// A new object of the plugin.
  template <PluginInterface T>
  std::unique_ptr<T> make(const ConfigNode& from, std::string* resolved = nullptr) const {
    // A model is made before there is a scene.
    const Scene* around = std::is_same_v<T, Model> ? nullptr : scene.get();
    return loader->make<T>(from, around, {}, resolved);
  }
  template <PluginInterface T>
  std::unique_ptr<T> make() const {
    return make<T>(config());
  }
};

/// Rows for the library itself; fills in `name` and `loader`. False if there is no point in going
/// on.
bool check_library(Report& report, Subject& subject);

/// Rows for the parameters. False if no object can be made; says so in a skipped row instead of a
/// failed one where `needs_config` and no file was given.
template <PluginInterface T>
bool check_parameters(Report& report, const Subject& subject, bool needs_config = false);

void check_model(Report& report, const Subject& subject);
void check_objective(Report& report, const Subject& subject);
void check_optimizer(Report& report, const Subject& subject);
void check_source(Report& report, const Subject& subject);

}  // namespace hypotrack::contract
