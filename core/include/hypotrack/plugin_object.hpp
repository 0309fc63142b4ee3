#pragma once

#include <string>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Base of the interfaces of plugins: remembers how messages name the object.
///
/// Public functions of an interface check the answers of the plugin's `do_` functions. They name
/// the object in what it throws and where it crashes. An object without a label is checked alike,
/// and its exceptions pass through unchanged: the plugin that made it adds its own label.
class HYPOTRACK_API PluginObject {
 public:
  PluginObject(const PluginObject&) = delete;
  PluginObject& operator=(const PluginObject&) = delete;

  /// Sets how messages name the object, before other calls. `name`: its place in the scene, kind
  /// and name. `library`: the file of its class; empty: unknown.
  void set_label(std::string name, const std::string& library = {});
  /// Returns name and library; empty: none was set.
  const std::string& label() const { return label_; }
  /// Returns the name without the library; empty: none was set.
  const std::string& short_label() const { return short_label_; }
  /// Returns whether its Errors are complete messages, as those of a plugin that comes with
  /// hypotrack.
  bool explains() const { return explains_; }

 protected:
  PluginObject() = default;
  virtual ~PluginObject();

 private:
  std::string label_, short_label_;
  bool explains_ = false;
};

}  // namespace hypotrack
