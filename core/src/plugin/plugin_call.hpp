#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "base/exported.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin_object.hpp"
#include "plugin/running_plugin.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Sets the label of an object that a plugin of a scene made: the plugin's place there, kind, name
/// and library, such as
/// `a.yaml:7:3: optimizer 'pso' (/usr/lib/hypotrack/plugins/libhypotrack_optimizer_pso.so)`.
void set_label(PluginObject& object, std::string_view kind, const ConfigNode& config);

/// Throws the exception being handled again, with `who` before its message. Other exceptions than
/// Error become PluginError, std::bad_alloc an Error; Stopped stays. An empty `who` changes
/// nothing.
[[noreturn]] void rethrow_from(const std::string& who);

/// Calls a function of a plugin. Names the plugin in what it throws, and if it crashes.
template <class Function>
decltype(auto) call_plugin(const std::string& who, Function&& function) {
  const RunningPlugin running(who.empty() ? nullptr : who.c_str());
  try {
    return std::forward<Function>(function)();
  } catch (...) {
    rethrow_from(who);
  }
}

/// Calls a function of a plugin as above. `explains`: its Errors are complete messages, which pass
/// through unchanged. `place`, such as `frame 3`, stands before `who` in other messages.
template <class Function>
decltype(auto) call_plugin(const std::string& who, bool explains, const std::string& place,
                           Function&& function) {
  const RunningPlugin running(who.c_str());
  try {
    return std::forward<Function>(function)();
  } catch (const Error&) {
    if (explains) throw;
    rethrow_from(place.empty() ? who : place + ": " + who);
  } catch (...) {
    rethrow_from(place.empty() ? who : place + ": " + who);
  }
}

/// Calls a function that works on a frame. Names the frame in what it throws, and if it crashes.
template <class Function>
decltype(auto) in_frame(int index, Function&& function) {
  const RunningFrame running(index);
  try {
    return std::forward<Function>(function)();
  } catch (...) {
    rethrow_from(fmt::format("frame {}", index));
  }
}

/// Calls a function of an object that a plugin made. Its label, if it has one, names it in what it
/// throws, and if it crashes.
template <class Function>
decltype(auto) call_plugin(const PluginObject& object, Function&& function) {
  if (object.label().empty()) return std::forward<Function>(function)();
  return call_plugin(object.label(), std::forward<Function>(function));
}

/// Calls a function as above, but lets Errors of an object that explains() them pass. `place`, such
/// as `frame 3`, stands before the label in other messages.
template <class Function>
decltype(auto) call_explained(const PluginObject& object, const std::string& place,
                              Function&& function) {
  if (object.label().empty()) return std::forward<Function>(function)();
  return call_plugin(object.label(), object.explains(), place, std::forward<Function>(function));
}

/// Returns the label of an object, or `otherwise` if it has none.
inline std::string label_or(const PluginObject& object, const char* otherwise) {
  return object.label().empty() ? otherwise : object.label();
}

/// Returns the type name of the exception being handled: `int`.
std::string current_exception_name();

}  // namespace internal
}  // namespace hypotrack::detail
