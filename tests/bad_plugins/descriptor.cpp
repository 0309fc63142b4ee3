// Plugins that differ from a proper one in at most one member of the descriptor. Which one is the
// name that CMake gives.
#include <signal.h>

#include <cstring>
#include <stdexcept>

#include "hypotrack/plugin/plugin.hpp"

namespace {

void* create_nothing(hypotrack::PluginContext&) { return nullptr; }
std::string describe_nothing() { return ""; }

[[maybe_unused]] std::string crash() {
  signal(SIGSEGV, SIG_DFL);
  raise(SIGSEGV);
  return "";
}

hypotrack::HypotrackPlugin proper_descriptor() {
  hypotrack::HypotrackPlugin plugin{};
  std::memcpy(plugin.magic, hypotrack::kPluginMagic.data(), sizeof(plugin.magic));
  plugin.struct_size = sizeof(plugin);
  plugin.abi_version = hypotrack::kAbiVersion;
  plugin.build_tag = hypotrack::kBuildTag;
  plugin.kind = HYPOTRACK_STRINGIZE(HYPOTRACK_PLUGIN_KIND);
  plugin.name = HYPOTRACK_STRINGIZE(HYPOTRACK_PLUGIN_NAME);
  plugin.version = HYPOTRACK_PLUGIN_VERSION;
  plugin.summary = "has one fault";
  plugin.licence = HYPOTRACK_PLUGIN_LICENCE;
  plugin.capabilities = "";
  plugin.create = create_nothing;
  plugin.describe = describe_nothing;
  return plugin;
}

[[maybe_unused]] constexpr const char* kOtherTag =
    "c++ 201703L, cxxabi 1017, cxx11-strings 1, eigen 3.4.0, eigen-align 64, opencv 4.6.0, "
    "sanitizer none";

[[maybe_unused]] hypotrack::HypotrackPlugin faulty_descriptor() {
  auto plugin = proper_descriptor();
#if defined(FIXTURE_wrong_magic)
  std::memcpy(plugin.magic, "another\x01plugin!!", sizeof(plugin.magic));
#elif defined(FIXTURE_other_abi)
  plugin.abi_version = hypotrack::kAbiVersion + 1;
  plugin.struct_size = 8;
#elif defined(FIXTURE_short_descriptor)
  plugin.struct_size = 40;
#elif defined(FIXTURE_other_tag)
  plugin.build_tag = kOtherTag;
#elif defined(FIXTURE_wrong_kind)
  plugin.kind = "objective";
#elif defined(FIXTURE_wrong_name)
  plugin.name = "somebody_else";
#elif defined(FIXTURE_empty_members)
  plugin.summary = nullptr;
#elif defined(FIXTURE_crash_in_describe)
  plugin.describe = crash;
#elif defined(FIXTURE_throwing_entry)
  throw std::runtime_error("no descriptor");
#endif
  return plugin;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const hypotrack::HypotrackPlugin*
hypotrack_plugin() {
#if defined(FIXTURE_null_descriptor)
  return nullptr;
#else
  static const hypotrack::HypotrackPlugin plugin = faulty_descriptor();
  return &plugin;
#endif
}
