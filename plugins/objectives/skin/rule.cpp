#include "rule.hpp"

#include "hypotrack/gpu/device_objective.hpp"

namespace hypotrack::skin {

Rule rule_of(Foreground foreground, bool has_color, bool has_mask, bool has_depth) {
  switch (foreground) {
    case Foreground::automatic:
      return has_mask ? Rule::mask : has_color ? Rule::color : Rule::none;
    case Foreground::color:
      return has_color ? Rule::color : Rule::none;
    case Foreground::mask:
      return has_mask ? Rule::mask : Rule::none;
    case Foreground::depth:
      return has_depth ? Rule::depth : Rule::none;
  }
  return Rule::none;
}

Rule rule_of(Foreground foreground, const cuda::DeviceTile& tile) {
  return rule_of(foreground, tile.has_color, tile.has_mask, tile.layout.depth != nullptr);
}

}  // namespace hypotrack::skin
