#pragma once

#include <functional>
#include <string>

namespace hypotrack {

class PluginContext;

/// A plugin that is part of a program instead of a library. program_plugin() (plugin.hpp) makes
/// one.
struct ProgramPlugin {
  std::string kind;  ///< of HYPOTRACK_PLUGIN_KINDS
  std::string name;  ///< small letters, digits and _: the `type` in scenes
  /// Makes a new object of the kind's interface, which the caller owns.
  std::function<void*(PluginContext&)> create;
};

}  // namespace hypotrack
