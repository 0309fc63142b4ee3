#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "base/exported.hpp"
#include "hypotrack/config.hpp"
#include "hypotrack/error.hpp"
#include "plugin/running_plugin.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Names a plugin of a scene: its place there, kind, name and library.
/// `a.yaml:7:3: optimizer 'pso' (/usr/lib/hypotrack/plugins/libhypotrack_optimizer_pso.so)`.
/// `object`: what the plugin made; its class has virtual functions.
std::string plugin_label(std::string_view kind, const ConfigNode& config, const void* object);

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

/// Returns whether the library of a plugin's object came with hypotrack. Then its Errors are
/// complete messages.
bool comes_with_hypotrack(const void* object);

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

/// Returns the type name of the exception being handled: `int`.
std::string current_exception_name();

}  // namespace internal
}  // namespace hypotrack::detail
