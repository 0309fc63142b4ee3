#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/program_plugin.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/build_tag.hpp"
#include "hypotrack/plugin/judge.hpp"
#include "hypotrack/plugin/model.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/output.hpp"
#include "hypotrack/plugin/params.hpp"
#include "hypotrack/plugin/plugin_object.hpp"
#include "hypotrack/plugin/source.hpp"
#include "hypotrack/plugin/starter.hpp"

/// The table of plugin kinds: KIND(name, Interface). The loader, the contract tests, CMake and
/// scripts take their kinds from here; they need each row on a line of its own.
#define HYPOTRACK_PLUGIN_KINDS(KIND) \
  KIND(model, Model)                 \
  KIND(objective, Objective)         \
  KIND(optimizer, Optimizer)         \
  KIND(source, Source)               \
  KIND(starter, Starter)             \
  KIND(judge, Judge)                 \
  KIND(output, Output)

namespace hypotrack {

class PluginContext;
struct MeshArrays;

/// Name of a plugin kind in YAML keys, file names and messages.
template <class T>
inline constexpr std::string_view kPluginKind = {};
#define HYPOTRACK_KIND(name, Interface) \
  template <>                           \
  inline constexpr std::string_view kPluginKind<Interface> = #name;
HYPOTRACK_PLUGIN_KINDS(HYPOTRACK_KIND)
#undef HYPOTRACK_KIND

template <class T>
concept PluginInterface = !kPluginKind<T>.empty();

/// Opens plugin libraries and makes objects from YAML. An optimizer with `type: pso` comes from
/// `libhypotrack_optimizer_pso.so` on the search path. A library is opened when first named and
/// never closed.
class HYPOTRACK_API PluginLoader {
 public:
  /// Searches `extra`, then HYPOTRACK_PLUGIN_PATH, then the plugin folder of this build or
  /// installation; never the working directory.
  explicit PluginLoader(std::vector<std::filesystem::path> extra = {});
  ~PluginLoader();
  PluginLoader(const PluginLoader&) = delete;
  PluginLoader& operator=(const PluginLoader&) = delete;

  const std::vector<std::filesystem::path>& search_path() const;

  /// Adds a plugin of this program, which replaces a library of its kind and name. Throws
  /// PluginError if there is no such kind, or on a name that no scene could give.
  void add(ProgramPlugin plugin);
  /// Lets scenes name a mesh of this program as `attached:NAME`.
  void attach(const std::string& name, MeshArrays mesh);
  /// Returns what scenes have taken from this program: `the mesh attached:cube`.
  std::vector<std::string> taken_from_program() const;

  /// Makes the object that `config` (a map with a `type`) describes. The caller reads the keys
  /// `also_allowed` itself. `resolved`, if given, receives all parameters with their values as
  /// YAML, `type` first. `notes`, if given, receives what the object tells the user. Throws
  /// ConfigError or PluginError.
  template <PluginInterface T>
  std::unique_ptr<T> make(const ConfigNode& config, const Scene* scene = nullptr,
                          std::vector<std::string> also_allowed = {},
                          std::string* resolved = nullptr,
                          std::shared_ptr<PluginNotes> notes = nullptr) {
    return std::unique_ptr<T>(static_cast<T*>(make_object(
        kPluginKind<T>, config, scene, std::move(also_allowed), resolved, std::move(notes))));
  }

 private:
  friend class PluginContext;
  const MeshArrays& attached_mesh(const std::string& name, const ConfigNode& config);
  void* make_object(std::string_view kind, const ConfigNode& config, const Scene* scene,
                    std::vector<std::string> also_allowed, std::string* resolved,
                    std::shared_ptr<PluginNotes> notes);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Services for a plugin's constructor: the scene, other plugins, a log, and the node of its
/// parameters.
class HYPOTRACK_API PluginContext {
 public:
  PluginContext(ConfigNode config, const Scene* scene, PluginLoader& plugins,
                std::vector<std::string> also_allowed, std::shared_ptr<PluginNotes> notes = nullptr,
                std::string who = {});

  /// Reads the parameters strictly and records their values for the run's protocol. Absent keys
  /// keep the values of `params`.
  template <ParamStruct P>
  P read(P params = P{}) {
    params = ParamReader(config_, also_allowed_).template read<P>(std::move(params));
    resolved_ = dump_params(params);
    return params;
  }

  /// Returns the tracked models. Throws PluginError in a model plugin, which has no scene yet.
  const Scene& scene() const;
  /// Makes another plugin from a nested map (a mirrored model, a wrapped source). Its parameters
  /// join the record in their place.
  template <PluginInterface T>
  std::unique_ptr<T> make(const ConfigNode& config) {
    std::string resolved;
    auto object = plugins_->make<T>(config, scene_, {}, &resolved, notes_);
    record_nested(config, resolved);
    return object;
  }
  /// Returns the mesh that the program attached under a name. It lives as long as the loader.
  /// Throws ConfigError if there is none.
  const MeshArrays& attached_mesh(const std::string& name) const {
    return plugins_->attached_mesh(name, config_);
  }
  /// Returns the log that tells the user something under the plugin's name. Keep a copy.
  PluginLog log() const { return {notes_, who_}; }
  /// Returns the node of the parameters, for error messages: config().where().
  const ConfigNode& config() const { return config_; }
  const std::string& resolved() const { return resolved_; }

 private:
  void record_nested(const ConfigNode& config, const std::string& resolved);

  ConfigNode config_;
  const Scene* scene_;
  PluginLoader* plugins_;
  std::vector<std::string> also_allowed_;
  std::string resolved_;
  std::shared_ptr<PluginNotes> notes_;
  std::string who_;
};

/// Makes a plugin of a program, for SessionOptions::plugins. `make` may read parameters from the
/// context.
template <PluginInterface T>
ProgramPlugin program_plugin(std::string name,
                             std::function<std::unique_ptr<T>(PluginContext&)> make) {
  return {std::string(kPluginKind<T>), std::move(name),
          [make = std::move(make)](PluginContext& context) -> void* {
            return make(context).release();
          }};
}

inline constexpr std::uint32_t kAbiVersion = 26;

/// The C interface of a plugin library. The loader compares magic, size, version and tag before it
/// reads anything else. So the struct must stay plain C and may only grow at the end.
struct HypotrackPlugin {
  char magic[16];  ///< kPluginMagic
  std::uint32_t struct_size;
  std::uint32_t abi_version;
  const char* build_tag;  ///< kBuildTag of the headers it was compiled with
  const char* kind;
  const char* name;
  const char* version;
  const char* summary;
  const char* licence;
  /// Space-separated, may be empty; `hypotrack plugins capabilities` explains the known words.
  const char* capabilities;
  void* (*create)(PluginContext&);
  std::string (*describe)();  ///< help text of the parameters
};

inline constexpr std::string_view kPluginMagic = "hypotrack plugin";  // 16 characters, no NUL
inline constexpr const char* kPluginEntry = "hypotrack_plugin";

namespace detail {

/// Says at compile time what a plugin's class lacks: one message, and what to write. Returns false
/// then.
template <class Kind, class T>
consteval bool is_plugin_class() {
  constexpr bool kDerived = std::derived_from<T, Kind>;
#define HYPOTRACK_KIND(name, Interface) " " #Interface
  static_assert(
      kDerived,
      "HYPOTRACK_PLUGIN: the class does not derive from the interface of its kind. Write "
      "`class Mine : public hypotrack::Optimizer`, with the interface of the KIND that "
      "CMake's hypotrack_add_plugin() gets, one of" HYPOTRACK_PLUGIN_KINDS(HYPOTRACK_KIND));
#undef HYPOTRACK_KIND
  constexpr bool kHasParams = requires { typename T::Params; };
  static_assert(
      kHasParams,
      "HYPOTRACK_PLUGIN: the class has no public type Params. Write "
      "`struct Params { void visit(hypotrack::ParamVisitor& v) {} };` in its public part");
  if constexpr (kDerived && kHasParams) {
    using Params = typename T::Params;
    constexpr bool kVisits = ParamStruct<Params> && std::default_initializable<Params>;
    static_assert(
        kVisits,
        "HYPOTRACK_PLUGIN: Params has no public `void visit(hypotrack::ParamVisitor& v)` "
        "or no default values. Write "
        "`int size = 4; void visit(hypotrack::ParamVisitor& v) { v(\"size\", size, {}); }`");
    constexpr bool kMade = std::is_abstract_v<T> ||
                           std::constructible_from<T, const Params&, PluginContext&> ||
                           std::constructible_from<T, const Params&>;
    static_assert(kMade,
                  "HYPOTRACK_PLUGIN: the class cannot be made from its parameters. Write a public "
                  "`explicit Mine(const Params& params)` or "
                  "`Mine(const Params& params, hypotrack::PluginContext& context)`");
    return kVisits && kMade;
  }
  return false;
}

template <class Kind, class T>
void* create_plugin(PluginContext& context) {
  if constexpr (is_plugin_class<Kind, T>()) {
    const auto params = context.template read<typename T::Params>();
    std::unique_ptr<Kind> object;
    // `new`: the compiler's message of an abstract class is short and names what is missing.
    if constexpr (std::constructible_from<T, const typename T::Params&, PluginContext&>)
      object.reset(new T(params, context));
    else
      object.reset(new T(params));
    return object.release();
  } else {
    return nullptr;
  }
}

template <class Kind, class T>
std::string describe_plugin() {
  if constexpr (is_plugin_class<Kind, T>())
    return describe_params<typename T::Params>();
  else
    return {};
}

#define HYPOTRACK_KIND(name, Interface) using name = Interface;
HYPOTRACK_PLUGIN_KINDS(HYPOTRACK_KIND)
#undef HYPOTRACK_KIND
}  // namespace detail

}  // namespace hypotrack

#define HYPOTRACK_STRINGIZE_(x) #x
#define HYPOTRACK_STRINGIZE(x) HYPOTRACK_STRINGIZE_(x)

/// Makes a class the plugin of its library; use it once per library. The class derives from an
/// interface of HYPOTRACK_PLUGIN_KINDS and has a nested ParamStruct `Params`. It is constructible
/// from (const Params&) or (const Params&, PluginContext&). hypotrack_add_plugin() in CMake gives
/// kind, name, version and licence.
#define HYPOTRACK_PLUGIN(Class, Summary, Capabilities)                                             \
  extern "C" __attribute__((visibility("default"))) const ::hypotrack::HypotrackPlugin*            \
  hypotrack_plugin() {                                                                             \
    static const ::hypotrack::HypotrackPlugin plugin = {                                           \
        {'h', 'y', 'p', 'o', 't', 'r', 'a', 'c', 'k', ' ', 'p', 'l', 'u', 'g', 'i', 'n'},          \
        sizeof(::hypotrack::HypotrackPlugin),                                                      \
        ::hypotrack::kAbiVersion,                                                                  \
        ::hypotrack::kBuildTag,                                                                    \
        HYPOTRACK_STRINGIZE(HYPOTRACK_PLUGIN_KIND),                                                \
        HYPOTRACK_STRINGIZE(HYPOTRACK_PLUGIN_NAME),                                                \
        HYPOTRACK_PLUGIN_VERSION,                                                                  \
        Summary,                                                                                   \
        HYPOTRACK_PLUGIN_LICENCE,                                                                  \
        Capabilities,                                                                              \
        &::hypotrack::detail::create_plugin<::hypotrack::detail::HYPOTRACK_PLUGIN_KIND, Class>,    \
        &::hypotrack::detail::describe_plugin<::hypotrack::detail::HYPOTRACK_PLUGIN_KIND, Class>}; \
    return &plugin;                                                                                \
  }
