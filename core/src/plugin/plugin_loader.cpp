#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <mutex>
#include <set>

#include "config/read_value.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "hypotrack/api/stop.hpp"
#include "hypotrack/api/text.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "plugin/crash_report.hpp"
#include "plugin/folders.hpp"
#include "plugin/library.hpp"
#include "plugin/plugin_call.hpp"

namespace hypotrack {
namespace {

/// Returns the name of the plugin that a node selects.
std::string type_of(std::string_view kind, const ConfigNode& config) {
  if (!config.is_map()) {
    detail::fail_at(config, fmt::format("{}; expected a map with `type: NAME`, the {} to use",
                                        config.defined() ? "is no map" : "is missing", kind));
  }
  const ConfigNode type = config.get("type");
  if (!type.defined())
    detail::fail_at(type, fmt::format("is missing; it names the {} to use", kind));
  if (!type.is_scalar() || type.is_null()) {
    detail::fail_at(type, fmt::format("expected the name of the {} to use", kind));
  }
  if (!detail::is_plugin_name(type.scalar())) {
    detail::fail_at(
        type, fmt::format("'{}' cannot be the name of a plugin; expected small letters, digits "
                          "and '_'",
                          type.scalar()));
  }
  return type.scalar();
}

std::string join_paths(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::string> texts;
  for (const auto& path : paths) {
    std::error_code error;
    const bool there = std::filesystem::is_directory(path, error);
    texts.push_back(path.string() + (there ? "" : " (there is no such folder)"));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// Runs a plugin's factory; converts exceptions other than Error to PluginError.
template <class Create>
void* create(std::string_view kind, const std::string& name, const Create& make,
             PluginContext& context) {
  const std::string who = fmt::format("{}: {} '{}'", context.config().where(), kind, name);
  const detail::RunningPlugin running(who.c_str(), " while it was made");
  void* object = nullptr;
  try {
    object = make(context);
  } catch (const DataError& e) {
    // Core says `model: vertex 0 ...` of what a plugin gave it.
    const std::string_view message = e.what();
    if (!message.starts_with(std::string(kind) + ": ")) throw;
    throw DataError(who + std::string(message.substr(kind.size())));
  } catch (const Error&) {
    throw;
  } catch (const Stopped&) {
    throw;
  } catch (const std::exception& e) {
    throw PluginError(fmt::format("{}: could not be made: its constructor threw {}: {}", who,
                                  detail::current_exception_name(), e.what()));
  } catch (...) {
    throw PluginError(
        fmt::format("{}: could not be made: its constructor threw {}, which is no std::exception",
                    who, detail::current_exception_name()));
  }
  if (!object)
    throw PluginError(fmt::format("{}: could not be made: its factory returned null", who));
  return object;
}

}  // namespace

struct PluginLoader::Impl {
  std::vector<std::filesystem::path> search_path;
  std::mutex mutex;
  std::map<std::string, const HypotrackPlugin*> open;  ///< by file
  std::vector<ProgramPlugin> own;                      ///< of the program
  std::map<std::string, MeshArrays> meshes;            ///< of the program, by name
  std::set<std::string> taken;                         ///< of both

  const ProgramPlugin* find_own(std::string_view kind, const std::string& name) const {
    const auto found = std::ranges::find_if(
        own, [&](const ProgramPlugin& p) { return p.kind == kind && p.name == name; });
    return found == own.end() ? nullptr : &*found;
  }

  void take(std::string what) {
    const std::lock_guard lock(mutex);
    taken.insert(std::move(what));
  }

  std::filesystem::path find(std::string_view kind, const std::string& name,
                             const ConfigNode& type) const {
    for (const auto& folder : search_path) {
      auto file = folder / detail::library_file_name(kind, name);
      if (std::filesystem::exists(file)) return file;
    }
    auto names = detail::plugin_names(kind, search_path);
    for (const ProgramPlugin& plugin : own)
      if (plugin.kind == kind) names.push_back(plugin.name);
    const std::string meant = did_you_mean(name, names);
    const std::string others =
        names.empty() ? fmt::format(" and no other {} either", kind)
                      : fmt::format("{} {}", meant.empty() ? "; there are:" : meant + " There are:",
                                    fmt::join(names, ", "));
    throw PluginError(fmt::format("{}: there is no {} '{}'{}. Searched for {} in {}",
                                  detail::with_path(type.where(), type.path()), kind, name, others,
                                  detail::library_file_name(kind, name), join_paths(search_path)));
  }

  const HypotrackPlugin& get(std::string_view kind, const std::string& name,
                             const ConfigNode& type) {
    const std::filesystem::path file = find(kind, name, type);
    const std::lock_guard lock(mutex);
    const HypotrackPlugin*& plugin = open[file.string()];
    if (!plugin) plugin = &open_plugin(file, {std::string(kind), name});
    return *plugin;
  }

  static const HypotrackPlugin& open_plugin(const std::filesystem::path& file,
                                            const detail::PluginId& id) {
    const std::string how =
        fmt::format(" while it was loaded; `hypotrack plugins check {}` says how", file.string());
    std::string problem;
    try {
      const detail::CrashReport report;
      const detail::RunningPlugin running(file.c_str(), how.c_str());
      const HypotrackPlugin& plugin = detail::descriptor_of(detail::load_library(file));
      problem = detail::find_mismatch(plugin, id);
      if (problem.empty()) return plugin;
    } catch (const PluginError& e) {
      problem = e.what();
    }
    throw PluginError(fmt::format("{}: {}", file.string(), problem));
  }
};

PluginLoader::PluginLoader(std::vector<std::filesystem::path> extra)
    : impl_(std::make_unique<Impl>()) {
  impl_->search_path = detail::plugin_search_path(extra);
}
PluginLoader::~PluginLoader() = default;

void PluginLoader::add(ProgramPlugin plugin) {
  if (std::ranges::find(detail::kPluginKinds, plugin.kind) == std::end(detail::kPluginKinds))
    throw PluginError(fmt::format("there is no kind of plugin '{}'; expected one of {}",
                                  plugin.kind, fmt::join(detail::kPluginKinds, ", ")));
  if (!detail::is_plugin_name(plugin.name) || !plugin.create)
    throw PluginError(
        fmt::format("'{}' cannot be the {} of a program; expected a name of small letters, digits "
                    "and '_', and a function that makes it",
                    plugin.name, plugin.kind));
  std::erase_if(impl_->own, [&](const ProgramPlugin& other) {
    return other.kind == plugin.kind && other.name == plugin.name;
  });
  impl_->own.push_back(std::move(plugin));
}

void PluginLoader::attach(const std::string& name, MeshArrays mesh) {
  impl_->meshes[name] = std::move(mesh);
}

const MeshArrays& PluginLoader::attached_mesh(const std::string& name, const ConfigNode& config) {
  const auto found = impl_->meshes.find(name);
  if (found == impl_->meshes.end()) {
    std::vector<std::string> names;
    for (const auto& entry : impl_->meshes) names.push_back(entry.first);
    throw ConfigError(fmt::format(
        "{}: '{}{}' is a mesh in the memory of the program that made this scene; expected the name "
        "of a file, or a program that attaches a mesh of this name; attached {}",
        config.where(), detail::kAttached, name,
        names.empty() ? "is none" : fmt::format("are {}", fmt::join(names, ", "))));
  }
  impl_->take(fmt::format("the mesh {}{}", detail::kAttached, name));
  return found->second;
}

std::vector<std::string> PluginLoader::taken_from_program() const {
  const std::lock_guard lock(impl_->mutex);
  return {impl_->taken.begin(), impl_->taken.end()};
}

const std::vector<std::filesystem::path>& PluginLoader::search_path() const {
  return impl_->search_path;
}

void* PluginLoader::make_object(std::string_view kind, const ConfigNode& config, const Scene* scene,
                                std::vector<std::string> also_allowed, std::string* resolved,
                                std::shared_ptr<PluginNotes> notes) {
  const std::string name = type_of(kind, config);
  const ProgramPlugin* own = impl_->find_own(kind, name);
  const HypotrackPlugin* library = own ? nullptr : &impl_->get(kind, name, config.get("type"));
  if (own) impl_->take(fmt::format("the {} '{}'", kind, name));
  also_allowed.insert(also_allowed.begin(), "type");
  const std::string path = config.path();
  PluginContext context(config, scene, *this, std::move(also_allowed), std::move(notes),
                        fmt::format("{} ({})", path.empty() ? kind : path, name));
  void* object =
      own ? create(kind, name, own->create, context) : create(kind, name, library->create, context);
  if (resolved) *resolved = fmt::format("type: {}\n{}", name, context.resolved());
  return object;
}

}  // namespace hypotrack
