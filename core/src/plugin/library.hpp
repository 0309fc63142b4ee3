#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Kind and name from a library's file name: libhypotrack_<kind>_<name>.so.
struct PluginId {
  std::string kind;
  std::string name;
};

#define HYPOTRACK_KIND(name, Interface) #name,
inline constexpr std::string_view kPluginKinds[] = {HYPOTRACK_PLUGIN_KINDS(HYPOTRACK_KIND)};
#undef HYPOTRACK_KIND

/// Returns the version of hypotrack without the patch, which the binary interface has: `0.2`.
std::string_view minor_version();

std::string library_file_name(std::string_view kind, std::string_view name);

/// Parses a library's file name; returns nothing if it is not a plugin library's.
std::optional<PluginId> id_from_file_name(const std::filesystem::path& file);

/// Returns true if a text is a valid plugin name: [a-z0-9_]+.
bool is_plugin_name(std::string_view name);

/// Returns the sorted names of all plugins of a kind on the search path.
std::vector<std::string> plugin_names(std::string_view kind,
                                      std::span<const std::filesystem::path> search_path);

/// Opens a library and never closes it. Throws PluginError without naming the file.
void* load_library(const std::filesystem::path& file);

/// Returns the descriptor of an opened library, unchecked. Throws PluginError without naming the
/// file.
const HypotrackPlugin& descriptor_of(void* library);

/// Returns why this hypotrack cannot use a plugin, with both sides of the mismatch; empty if it
/// can. Checks that a member exists before it reads it.
std::string find_mismatch(const HypotrackPlugin& plugin, const PluginId& expected);

/// Returns the size in bytes that an ELF file must have by its headers. Detects truncated files:
/// the dynamic linker maps them as if complete, and the program then dies of SIGBUS. Returns 0 if
/// the file is not an ELF file of this machine's word size or lacks a whole first header.
std::uintmax_t elf_size(const std::filesystem::path& file);

/// File descriptor of the probe program's report, separate from anything that a plugin prints.
inline constexpr int kProbeDescriptor = 3;

// Lines of the report: one as each step begins, then the result as one line of JSON.
inline constexpr const char* kProbeLoading = "while loading";
inline constexpr const char* kProbeEntry = "while returning its descriptor";
inline constexpr const char* kProbeDescribing = "while describing its parameters";

/// Opens a library, writes the report and exits: the probe program's main function.
[[noreturn]] void run_probe(const std::filesystem::path& file);

}  // namespace internal
}  // namespace hypotrack::detail
