#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the keys beside `type` that a scene reads itself where it names a plugin of this kind. A
/// parameter of the plugin cannot have such a name.
inline std::vector<std::string> scene_keys(std::string_view kind) {
  if (kind == "model") return {"name"};
  if (kind == "objective") return {"weight"};
  return {};
}

/// A line of describe_params(): key, type and help, with two spaces or more between them.
struct HelpLine {
  std::size_t depth = 0;  ///< 0 for a parameter of the plugin itself
  std::string_view key, type, help;
};

/// Splits the text of describe_params() into its lines. They refer to the text.
std::vector<HelpLine> help_lines(std::string_view text);

}  // namespace internal
}  // namespace hypotrack::detail
