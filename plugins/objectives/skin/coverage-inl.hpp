// Included once per instruction set: no #pragma once.
#if defined(SKIN_COVERAGE_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef SKIN_COVERAGE_INL_HPP_
#undef SKIN_COVERAGE_INL_HPP_
#else
#define SKIN_COVERAGE_INL_HPP_
#endif

#include "hypotrack/pixel.hpp"

/// The per-pixel function of the skin objective, for every lane type (pixel.hpp).
HYPOTRACK_PIXEL_BEGIN();
namespace hypotrack::skin::HYPOTRACK_TARGET {

/// What covering a pixel changes: spill (1 - P) instead of P. `foreground` is P, `background` 1 -
/// P, or 0 and 0 where nobody looked.
template <class F>
HYPOTRACK_PIXEL F change_if_covered(F foreground, F background, F spill) {
  return spill * background - foreground;
}

/// What is squared at a covered pixel: the root of what it costs, share spill (1 - P).
template <class F>
HYPOTRACK_PIXEL F covered_residual(F background, F spill, F share) {
  using pixel::sqrt;
  return sqrt(share * spill * background);
}

}  // namespace hypotrack::skin::HYPOTRACK_TARGET
HYPOTRACK_PIXEL_END();

#endif
