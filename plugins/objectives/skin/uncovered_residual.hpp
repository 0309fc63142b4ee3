#pragma once

#include "hypotrack/pixel.hpp"

namespace hypotrack::skin {

/// What is squared at a pixel that is not covered: the root of what it costs, share P.
HYPOTRACK_PIXEL float uncovered_residual(float foreground, float share) {
  return pixel::sqrt(share * foreground);
}

}  // namespace hypotrack::skin
