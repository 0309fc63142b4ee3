#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <mutex>

#include "config/read_value.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/plugin.hpp"
#include "hypotrack/suggest.hpp"
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
void* create(const HypotrackPlugin& plugin, PluginContext& context) {
  const std::string who =
      fmt::format("{}: {} '{}'", context.config().where(), plugin.kind, plugin.name);
  const detail::RunningPlugin running(who.c_str(), " while it was made");
  void* object = nullptr;
  try {
    object = plugin.create(context);
  } catch (const DataError& e) {
    // Core says `model: vertex 0 ...` of what a plugin gave it.
    const std::string_view message = e.what();
    if (!message.starts_with(std::string(plugin.kind) + ": ")) throw;
    throw DataError(who + std::string(message.substr(std::string_view(plugin.kind).size())));
  } catch (const Error&) {
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

  std::filesystem::path find(std::string_view kind, const std::string& name,
                             const ConfigNode& type) const {
    for (const auto& folder : search_path) {
      auto file = folder / detail::library_file_name(kind, name);
      if (std::filesystem::exists(file)) return file;
    }
    const auto names = detail::plugin_names(kind, search_path);
    const std::string meant = did_you_mean(name, names);
    const std::string others =
        names.empty() ? fmt::format(" and no other {} either", kind)
                      : fmt::format("{} {}", meant.empty() ? "; there are:" : meant + " There are:",
                                    fmt::join(names, ", "));
    throw PluginError(fmt::format("{}: {}: there is no {} '{}'{}. Searched for {} in {}",
                                  type.where(), type.path(), kind, name, others,
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

const std::vector<std::filesystem::path>& PluginLoader::search_path() const {
  return impl_->search_path;
}

void* PluginLoader::make_object(std::string_view kind, const ConfigNode& config, const Scene* scene,
                                std::vector<std::string> also_allowed, std::string* resolved,
                                std::shared_ptr<PluginNotes> notes) {
  const std::string name = type_of(kind, config);
  const HypotrackPlugin& plugin = impl_->get(kind, name, config.get("type"));
  also_allowed.insert(also_allowed.begin(), "type");
  const std::string path = config.path();
  PluginContext context(config, scene, *this, std::move(also_allowed), std::move(notes),
                        fmt::format("{} ({})", path.empty() ? kind : path, name));
  void* object = create(plugin, context);
  if (resolved) *resolved = fmt::format("type: {}\n{}", name, context.resolved());
  return object;
}

}  // namespace hypotrack
