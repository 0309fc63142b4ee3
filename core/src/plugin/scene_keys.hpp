#pragma once

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

}  // namespace internal
}  // namespace hypotrack::detail
