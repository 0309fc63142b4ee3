#pragma once

#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::skin {

/// Returns the residual of an uncovered pixel: the root of its cost, share P.
HYPOTRACK_PIXEL float uncovered_residual(float foreground, float share) {
  return pixel::sqrt(share * foreground);
}

}  // namespace hypotrack::skin
