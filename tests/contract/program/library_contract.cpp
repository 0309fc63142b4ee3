#include <dlfcn.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <sstream>

#include "hypotrack/api/text.hpp"
#include "plugin/capabilities.hpp"
#include "plugin/param_keys.hpp"
#include "subject.hpp"

namespace hypotrack::contract {
namespace {

const HypotrackPlugin& open_descriptor(const std::filesystem::path& library) {
  // Never closed, as in the program.
  void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  require(handle, "cannot be opened: " + std::string(handle ? "" : dlerror()));
  const auto entry = reinterpret_cast<const HypotrackPlugin* (*)()>(dlsym(handle, kPluginEntry));
  require(entry, "has no function '" + std::string(kPluginEntry) +
                     "', expected HYPOTRACK_PLUGIN(...) once in its sources");
  const HypotrackPlugin* plugin = entry();
  require(plugin, "returns no descriptor");
  return *plugin;
}

void check_handshake(const HypotrackPlugin& plugin) {
  require(std::string_view(plugin.magic, sizeof(plugin.magic)) == kPluginMagic,
          "the descriptor's magic is wrong");
  require(plugin.struct_size >= sizeof(HypotrackPlugin) && plugin.abi_version == kAbiVersion,
          "ABI version " + std::to_string(plugin.abi_version) + ", expected " +
              std::to_string(kAbiVersion) + ": build it against this hypotrack");
  require(std::strcmp(plugin.build_tag, kBuildTag) == 0,
          "built with [" + std::string(plugin.build_tag) + "], expected [" + kBuildTag + "]");
}

void check_names(const HypotrackPlugin& plugin, const Subject& subject) {
  require(plugin.kind && subject.kind == plugin.kind,
          "it is a plugin of kind '" + std::string(plugin.kind ? plugin.kind : "") +
              "', expected '" + subject.kind + "'");
  const std::string_view name = plugin.name ? plugin.name : "";
  const bool snake_case = !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return std::islower(c) || std::isdigit(c) || c == '_';
  });
  require(snake_case, "its name is '" + std::string(name) +
                          "', expected small letters, digits and underscores");
  const std::string file = "libhypotrack_" + subject.kind + "_" + std::string(name) + ".so";
  require(subject.library.filename() == file, "the file is " + subject.library.filename().string() +
                                                  ", expected " + file +
                                                  ": a scene could not find it");
}

void check_texts(const HypotrackPlugin& plugin) {
  require(plugin.version && *plugin.version, "has no version");
  require(plugin.summary && *plugin.summary, "has no summary, expected a line on what it does");
  require(plugin.licence && *plugin.licence, "has no licence, expected an SPDX name");
  require(plugin.capabilities, "its capabilities are null, expected a text, possibly empty");
  require(plugin.create && plugin.describe, "has no factory or no description");
}

/// Throws if a capability is nearly a known one. Plugins may have words of their own.
void check_capabilities(const HypotrackPlugin& plugin) {
  std::vector<std::string> known;
  for (const Capability& one : known_capabilities())
    if (one.kind == plugin.kind) known.emplace_back(one.word);
  std::istringstream words(plugin.capabilities);
  for (std::string word; words >> word;) {
    if (std::ranges::find(known, word) != known.end()) continue;
    const std::string nearest = did_you_mean(word, known);
    require(nearest.empty(), "nobody knows the capability '" + word + "'" + nearest +
                                 ". `hypotrack plugins capabilities` lists them");
  }
}

/// Throws unless every line of a plugin's help, also of nested parameters, says what it means.
void check_help(const std::string& help) {
  for (const detail::HelpLine& line : detail::help_lines(help))
    require(!line.help.empty(), "the parameter '" + std::string(line.key) +
                                    "' has none: write {.help = \"what it does\"} in visit()");
}

/// Throws if a parameter has the name of a key that scenes read themselves.
void check_keys(const std::string& help, const std::string& kind) {
  std::vector<std::string> taken = detail::scene_keys(kind);
  taken.push_back("type");
  for (const detail::HelpLine& line : detail::help_lines(help))
    require(line.depth > 0 || std::ranges::find(taken, line.key) == taken.end(),
            "scenes read '" + std::string(line.key) + "' of every " + kind +
                " themselves: give the parameter another name in visit()");
}

}  // namespace

bool Subject::claims(const std::string& capability) const {
  std::istringstream words(capabilities);
  return std::find(std::istream_iterator<std::string>(words), {}, capability) !=
         std::istream_iterator<std::string>();
}

ConfigNode Subject::config() const {
  if (config_file.empty()) return ConfigNode::parse("type: " + name, "contract.yaml");
  return ConfigNode::load_scene(config_file, std::vector{"type=" + name});
}

ConfigNode Subject::config_with(const std::string& more) const {
  const ConfigNode base = config();
  return ConfigNode::parse(base.to_yaml() + "\n" + more, "contract.yaml", base.directory());
}

bool check_library(Report& report, Subject& subject) {
  const HypotrackPlugin* plugin = nullptr;
  report.row("library opens and describes itself",
             [&] { plugin = &open_descriptor(subject.library); });
  if (!plugin) return false;
  report.row("library was built for this hypotrack", [&] { check_handshake(*plugin); });
  if (!report.passed()) return false;
  report.row("library is named by its kind and name", [&] { check_names(*plugin, subject); });
  if (!report.passed()) return false;
  report.row("library gives version, summary and licence", [&] { check_texts(*plugin); });
  if (!report.passed()) return false;
  report.row("no capability is misspelt", [&] { check_capabilities(*plugin); });
  subject.name = plugin->name;
  subject.capabilities = plugin->capabilities;
  subject.loader = std::make_unique<PluginLoader>(
      std::vector{std::filesystem::absolute(subject.library).parent_path()});
  return true;
}

template <PluginInterface T>
bool check_parameters(Report& report, const Subject& subject, bool needs_config) {
  std::string dump;
  report.row("no parameter has a name that scenes take",
             [&] { check_keys(open_descriptor(subject.library).describe(), subject.kind); });
  report.row("an object can be made", [&] {
    try {
      subject.make<T>(subject.config(), &dump);
    } catch (const DeviceError& error) {
      if (!subject.claims("needs_device")) throw;
      throw Skipped(error.what());
    } catch (const ConfigError& error) {
      const std::string advice =
          " (hypotrack_add_plugin(... CONTRACT_CONFIG FILE.yaml) gives the test parameters)";
      if (!subject.config_file.empty()) throw;
      if (needs_config) throw Skipped("it needs parameters: " + std::string(error.what()) + advice);
      throw Violation("not with the defaults: " + std::string(error.what()) + advice);
    }
  });
  if (!report.passed()) return false;
  report.row("every parameter has a line of help",
             [&] { check_help(open_descriptor(subject.library).describe()); });
  report.row("a dump of the parameters gives the same object", [&] {
    std::string again;
    subject.make<T>(ConfigNode::parse(dump, "dump"), &again);
    require(again == dump, "dumped\n" + dump + "    and then, read again,\n" + again);
  });
  report.row("an unknown parameter is an error with its place", [&] {
    try {
      subject.make<T>(subject.config_with("no_such_parameter: 1"));
    } catch (const ConfigError& error) {
      const std::string message = error.what();
      require(message.find("no_such_parameter") != message.npos &&
                  message.find("contract.yaml:") != message.npos,
              "the message is '" + message + "', expected file, line and name");
      return;
    }
    throw Violation("it was accepted, expected a ConfigError");
  });
  return true;
}

#define HYPOTRACK_KIND(name, Interface) \
  template bool check_parameters<Interface>(Report&, const Subject&, bool);
HYPOTRACK_PLUGIN_KINDS(HYPOTRACK_KIND)
#undef HYPOTRACK_KIND

}  // namespace hypotrack::contract
