#include "plugin/library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "hypotrack/api/error.hpp"

namespace hypotrack::detail::internal {
namespace {

constexpr std::string_view kFilePrefix = "libhypotrack_";
constexpr std::string_view kFileSuffix = ".so";

std::string_view text_of(const char* text) { return text ? text : "(null)"; }

/// Returns a magic number as printable text, whatever its bytes are.
std::string escaped(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    if (c >= 0x20 && c < 0x7F) {
      text += c;
    } else {
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  return text;
}

std::vector<std::string_view> split_tag(std::string_view tag) {
  std::vector<std::string_view> parts;
  while (!tag.empty()) {
    const std::size_t end = std::min(tag.find(", "), tag.size());
    parts.push_back(tag.substr(0, end));
    tag.remove_prefix(std::min(end + 2, tag.size()));
  }
  return parts;
}

/// Describes which parts of the plugin's build tag differ from hypotrack's.
std::string tag_difference(std::string_view theirs, std::string_view ours) {
  const auto missing_from = [](std::string_view these, std::string_view others) {
    const auto known = split_tag(others);
    auto parts = split_tag(these);
    std::erase_if(parts, [&](auto part) {
      return std::find(known.begin(), known.end(), part) != known.end();
    });
    return fmt::format("{}", fmt::join(parts, ", "));
  };
  return fmt::format("the plugin has '{}' where this hypotrack has '{}'",
                     missing_from(theirs, ours), missing_from(ours, theirs));
}

/// Returns the minor version of the hypotrack that a library was built for, if the dynamic linker
/// did not find that one: `0.1`. Empty otherwise.
std::string_view other_version(std::string_view reason) {
  constexpr std::string_view kName = "libhypotrack.so.", kMissing = ": cannot open";
  if (!reason.starts_with(kName)) return {};
  reason.remove_prefix(kName.size());
  const std::size_t end = reason.find(kMissing);
  return end == reason.npos ? std::string_view() : reason.substr(0, end);
}

/// Returns a file's size, or 0 if it is not a file.
std::uintmax_t file_size_of(const std::filesystem::path& file) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(file, none);
  return none ? 0 : size;
}

}  // namespace

std::string_view minor_version() {
  constexpr std::string_view kVersion = HYPOTRACK_VERSION;
  return kVersion.substr(0, kVersion.rfind('.'));
}

std::string library_file_name(std::string_view kind, std::string_view name) {
  return fmt::format("{}{}_{}{}", kFilePrefix, kind, name, kFileSuffix);
}

bool is_plugin_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

std::optional<PluginId> id_from_file_name(const std::filesystem::path& file) {
  const std::string full = file.filename().string();
  std::string_view text = full;
  if (!text.starts_with(kFilePrefix) || !text.ends_with(kFileSuffix)) return std::nullopt;
  if (text.size() < kFilePrefix.size() + kFileSuffix.size()) return std::nullopt;
  text.remove_prefix(kFilePrefix.size());
  text.remove_suffix(kFileSuffix.size());
  for (const std::string_view kind : kPluginKinds) {
    if (!text.starts_with(kind) || text.substr(kind.size()).substr(0, 1) != "_") continue;
    const std::string_view name = text.substr(kind.size() + 1);
    if (is_plugin_name(name)) return PluginId{std::string(kind), std::string(name)};
  }
  return std::nullopt;
}

std::vector<std::string> plugin_names(std::string_view kind,
                                      std::span<const std::filesystem::path> search_path) {
  std::set<std::string> names;
  for (const auto& folder : search_path) {
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
      const auto id = id_from_file_name(entry.path());
      if (id && id->kind == kind) names.insert(id->name);
    }
  }
  return {names.begin(), names.end()};
}

void* load_library(const std::filesystem::path& file) {
  if (const std::uintmax_t whole = elf_size(file), size = file_size_of(file); size < whole) {
    throw PluginError(fmt::format(
        "cannot be loaded: the file is cut off: it has {} of {} bytes; build or copy it again",
        size, whole));
  }
  // The absolute path stops the dynamic linker from searching. The library is never closed
  // (NODELETE, no dlclose), because a plugin's types and exceptions may live as long as the
  // process.
  const std::string path = std::filesystem::absolute(file).string();
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (!library) {
    std::string_view reason = text_of(dlerror());
    if (reason.starts_with(path + ": ")) reason.remove_prefix(path.size() + 2);
    if (const std::string_view version = other_version(reason); !version.empty())
      throw PluginError(fmt::format(
          "was built for hypotrack {}, this is {}; build it again with this hypotrack's headers",
          version, minor_version()));
    throw PluginError(fmt::format("cannot be loaded: {}", reason));
  }
  return library;
}

const HypotrackPlugin& descriptor_of(void* library) {
  void* symbol = dlsym(library, kPluginEntry);
  if (!symbol) {
    throw PluginError(
        fmt::format("is no hypotrack plugin: it has no function {}(); expected a library with one "
                    "HYPOTRACK_PLUGIN(...)",
                    kPluginEntry));
  }
  const HypotrackPlugin* plugin = nullptr;
  try {
    plugin = reinterpret_cast<const HypotrackPlugin* (*)()>(symbol)();
  } catch (...) {
    throw PluginError(
        fmt::format("{}() threw an exception instead of returning its descriptor", kPluginEntry));
  }
  if (!plugin) throw PluginError(fmt::format("{}() returned null", kPluginEntry));
  return *plugin;
}

std::string find_mismatch(const HypotrackPlugin& plugin, const PluginId& expected) {
  const std::string_view magic(plugin.magic, sizeof(plugin.magic));
  if (magic != kPluginMagic) {
    return fmt::format("is no hypotrack plugin: its descriptor begins with '{}', expected '{}'",
                       escaped(magic), kPluginMagic);
  }
  if (plugin.abi_version != kAbiVersion) {
    return fmt::format(
        "was built for plugin ABI version {}, this hypotrack has {}; build it again with this "
        "hypotrack's headers",
        plugin.abi_version, kAbiVersion);
  }
  if (plugin.struct_size < sizeof(HypotrackPlugin)) {
    return fmt::format(
        "its descriptor has {} bytes, this hypotrack needs {}; build it again with this "
        "hypotrack's headers",
        plugin.struct_size, sizeof(HypotrackPlugin));
  }
  if (text_of(plugin.build_tag) != kBuildTag) {
    return fmt::format(
        "was built differently: {}; build both with the same compiler, options and libraries. "
        "Plugin: '{}'. This hypotrack: '{}'",
        tag_difference(text_of(plugin.build_tag), kBuildTag), text_of(plugin.build_tag), kBuildTag);
  }
  if (text_of(plugin.kind) != expected.kind || text_of(plugin.name) != expected.name) {
    return fmt::format("says it is the {} '{}', its file name says the {} '{}'",
                       text_of(plugin.kind), text_of(plugin.name), expected.kind, expected.name);
  }
  if (!plugin.create || !plugin.describe || !plugin.version || !plugin.summary || !plugin.licence ||
      !plugin.capabilities) {
    return "its descriptor has empty members; fill it in with HYPOTRACK_PLUGIN(...)";
  }
  return "";
}

}  // namespace hypotrack::detail::internal
