#include "plugin/plugin_call.hpp"

#include <cxxabi.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <new>
#include <system_error>
#include <typeinfo>
#include <utility>

#include "base/system_problem.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/stop.hpp"
#include "plugin/folders.hpp"

namespace hypotrack::detail::internal {

namespace {

/// Returns the file of the library that defines an object's class; empty: unknown.
std::string library_of(const void* object) {
  Dl_info library{};
  const void* const vtable = *static_cast<const void* const*>(object);
  return dladdr(vtable, &library) != 0 && library.dli_fname ? library.dli_fname : "";
}

}  // namespace

void set_label(PluginObject& object, std::string_view kind, const ConfigNode& config) {
  object.set_label(fmt::format("{}: {} '{}'", config.where(), kind, config.get("type").scalar()),
                   library_of(&object));
}

void rethrow_from(const std::string& who) {
  if (who.empty()) throw;
  const auto message = [&](const std::exception& e) {
    return fmt::format("{}: {}", who, e.what());
  };
  try {
    throw;
  } catch (const Stopped&) {
    throw;
  } catch (const ConfigError& e) {
    throw ConfigError(message(e));
  } catch (const DataError& e) {
    throw DataError(message(e));
  } catch (const PluginError& e) {
    throw PluginError(message(e));
  } catch (const DeviceError& e) {
    throw DeviceError(message(e));
  } catch (const OutputError& e) {
    throw OutputError(message(e));
  } catch (const Error& e) {
    throw Error(message(e));
  } catch (const std::bad_alloc&) {
    throw Error(who + ": ran out of memory");
  } catch (const std::system_error& e) {
    throw Error(fmt::format("{}: {}", who, described(e)));
  } catch (const std::exception& e) {
    throw PluginError(fmt::format("{}: threw {}: {}", who, current_exception_name(), e.what()));
  } catch (...) {
    throw PluginError(
        fmt::format("{}: threw {}, which is no std::exception", who, current_exception_name()));
  }
}

std::string current_exception_name() {
  const std::type_info* type = abi::__cxa_current_exception_type();
  if (!type) return "an unknown type";
  int status = 0;
  char* readable = abi::__cxa_demangle(type->name(), nullptr, nullptr, &status);
  const std::string name = status == 0 ? readable : type->name();
  std::free(readable);
  return name;
}

}  // namespace hypotrack::detail::internal

namespace hypotrack {

PluginObject::~PluginObject() = default;

void PluginObject::set_label(std::string name, const std::string& library) {
  label_ = library.empty() ? name : fmt::format("{} ({})", name, library);
  short_label_ = std::move(name);
  std::error_code error;
  const auto folder = std::filesystem::path(library).parent_path();
  explains_ = std::filesystem::equivalent(folder, detail::own_plugin_folder(), error);
}

}  // namespace hypotrack
