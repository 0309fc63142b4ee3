// Included once per instruction set: no #pragma once.
#if defined(SKIN_COVERAGE_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef SKIN_COVERAGE_INL_HPP_
#undef SKIN_COVERAGE_INL_HPP_
#else
#define SKIN_COVERAGE_INL_HPP_
#endif

#include "hypotrack/plugin/pixel.hpp"

/// The per-pixel function of the skin objective, for every lane type (pixel.hpp).
HYPOTRACK_PIXEL_BEGIN();
namespace hypotrack::skin::HYPOTRACK_TARGET {

/// Returns the change of cost by covering a pixel: spill (1 - P) instead of P. `foreground` is P,
/// `background` is 1 - P; both are 0 at invalid pixels.
template <class F>
HYPOTRACK_PIXEL F change_if_covered(F foreground, F background, F spill) {
  return spill * background - foreground;
}

/// Returns the residual of a covered pixel: the root of its cost, share spill (1 - P).
template <class F>
HYPOTRACK_PIXEL F covered_residual(F background, F spill, F share) {
  using pixel::sqrt;
  return sqrt(share * spill * background);
}

}  // namespace hypotrack::skin::HYPOTRACK_TARGET
HYPOTRACK_PIXEL_END();

#endif
