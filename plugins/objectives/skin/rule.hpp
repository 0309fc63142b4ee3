#pragma once

#include "settings.hpp"

namespace hypotrack::cuda {
struct DeviceTile;
}

namespace hypotrack::skin {

/// Rule that decides foreground in a view, on the CPU and with CUDA.
enum class Rule { none, color, mask, depth };

/// Returns the rule for a view; `none` if it lacks the images that the rule needs.
Rule rule_of(Foreground foreground, bool has_color, bool has_mask, bool has_depth);
Rule rule_of(Foreground foreground, const cuda::DeviceTile& tile);

/// Depths z along a camera's axis, metres.
struct DepthRange {
  float nearest = 0, farthest = 0;
};

}  // namespace hypotrack::skin
