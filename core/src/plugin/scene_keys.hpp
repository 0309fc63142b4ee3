#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hypotrack::detail {

/// Returns the keys beside `type` that a scene reads itself where it names a plugin of this kind. A
/// parameter of the plugin cannot have such a name.
inline std::vector<std::string> scene_keys(std::string_view kind) {
  if (kind == "model") return {"name"};
  if (kind == "objective") return {"weight"};
  return {};
}

}  // namespace hypotrack::detail
