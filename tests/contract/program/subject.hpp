#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "hypotrack/plugin/plugin.hpp"
#include "report.hpp"

namespace hypotrack::contract {

/// The plugin under test: a library, the parameters to make it with, and a scene around it (one
/// right hand of 27 parameters, named `hand`).
struct Subject {
  std::string kind;
  std::filesystem::path library;
  std::string who;                    ///< kind and library, for messages
  std::filesystem::path config_file;  ///< parameters as in a scene; empty: the defaults
  std::string name;                   ///< from the library, once its descriptor was checked
  std::string capabilities;           ///< likewise
  std::unique_ptr<PluginLoader> loader;
  std::unique_ptr<Scene> scene;

  /// Returns whether the plugin says that it has a capability.
  bool claims(const std::string& capability) const;
  /// Returns the parameters with the plugin's `type`.
  ConfigNode config() const;
  /// Returns config() with one more line of YAML.
  ConfigNode config_with(const std::string& more) const;

  /// Makes a new object of the plugin.
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

/// Checks the library itself; sets `name` and `loader`. Returns false if further checks are
/// pointless.
bool check_library(Report& report, Subject& subject);

/// Checks the parameters. Returns false if no object can be made. Without a parameter file where
/// `needs_config`, the row is skipped instead of failed.
template <PluginInterface T>
bool check_parameters(Report& report, const Subject& subject, bool needs_config = false);

#define HYPOTRACK_KIND(name, Interface) void check_##name(Report& report, const Subject& subject);
HYPOTRACK_PLUGIN_KINDS(HYPOTRACK_KIND)
#undef HYPOTRACK_KIND

}  // namespace hypotrack::contract
