// Plugin libraries before they are loaded: the size that their headers tell, names and descriptors.

#include <cstring>

#include "plugin/library.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {
namespace {

/// Fills the numbers of a descriptor from bytes; its texts are the bytes.
void compare(std::string_view bytes, const std::string& text) {
  HypotrackPlugin plugin{};
  std::memcpy(&plugin.magic, kPluginMagic.data(), sizeof(plugin.magic));
  plugin.struct_size = sizeof(plugin);
  plugin.abi_version = kAbiVersion;
  plugin.build_tag = plugin.kind = plugin.name = text.c_str();
  detail::find_mismatch(plugin, {"model", "hand"});
  plugin.build_tag = kBuildTag;
  detail::find_mismatch(plugin, {text, text});
  if (bytes.size() < 16) return;
  std::memcpy(&plugin.magic, bytes.data(), sizeof(plugin.magic));
  detail::find_mismatch(plugin, {"model", "hand"});
}

}  // namespace

HYPOTRACK_FUZZ_TARGET(plugin_library, "plugin_library") {
  const std::string text(bytes);
  const auto id = detail::id_from_file_name(text.substr(0, text.find('\n')));
  require(!id || detail::is_plugin_name(id->name), "names of plugins are words");
  compare(bytes, text);
  detail::elf_size(scratch_file("libhypotrack_model_fuzz.so", bytes));
}

}  // namespace hypotrack::fuzz
