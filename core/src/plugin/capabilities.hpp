#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A word of a plugin's description that says what it offers or needs beyond its kind.
struct Capability {
  std::string_view kind;  ///< of the plugin
  std::string_view word;
  std::string_view meaning;
  bool by_build = false;  ///< only builds with CUDA have it
};

/// Returns the capabilities of the plugins that come with hypotrack, sorted by kind.
std::span<const Capability> known_capabilities();

/// Returns a known capability, or null. Plugins of others may have words of their own.
const Capability* find_capability(std::string_view kind, std::string_view word);

/// Formats a line per known capability: kind, word and meaning.
std::string format_capabilities();

/// Returns the same as a table of the documentation.
std::string format_capabilities_markdown();

}  // namespace internal
}  // namespace hypotrack
