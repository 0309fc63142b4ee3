// Included once per instruction set: no #pragma once.
#if defined(RGBD_DEPTH_DEPTH_AGREEMENT_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef RGBD_DEPTH_DEPTH_AGREEMENT_INL_HPP_
#undef RGBD_DEPTH_DEPTH_AGREEMENT_INL_HPP_
#else
#define RGBD_DEPTH_DEPTH_AGREEMENT_INL_HPP_
#endif

#include "foreground-inl.hpp"
#include "hypotrack/plugin/pixel.hpp"

/// The per-pixel functions of the rgbd_depth objective, for every lane type (pixel.hpp).
HYPOTRACK_PIXEL_BEGIN();
namespace hypotrack::rgbd_depth::HYPOTRACK_TARGET {

template <class F>
struct DepthAgreement {
  using Mask = decltype(F(0.0f) < F(0.0f));
  F closeness;   ///< d_M - min(|o_d - r_d|, d_M), metres; 0 where no foreground was measured
  Mask matched;  ///< o_s and r_m
  Mask beyond;   ///< r_m but not o_s
};

/// Compares a covered pixel with the observation there (foreground-inl.hpp).
template <class F>
HYPOTRACK_PIXEL DepthAgreement<F> depth_agreement(F inverse_depth, F observed, F d_max, F d_match) {
  using pixel::abs;
  using pixel::max;
  // The values for "not measured" are farther from every depth than d_max and d_match.
  const F difference = abs(observed - F(1.0f) / inverse_depth);
  return {max(d_max - difference, F(0.0f)), difference <= d_match || observed == F(kUnmeasured),
          observed == F(kBackground)};
}

/// Returns the signed difference of a covered pixel from the observation, -1 .. 1. It is (r_d -
/// o_d) / d_M, clamped, where foreground was measured, 1 on background, and 0 where nothing is
/// known.
template <class F>
HYPOTRACK_PIXEL F depth_residual(F inverse_depth, F observed, F d_max) {
  using pixel::max;
  using pixel::min;
  using pixel::select;
  // kBackground is so far in front of everything drawn that the value is 1.
  const F off = min(max((F(1.0f) / inverse_depth - observed) / d_max, F(-1.0f)), F(1.0f));
  return select(observed == F(kUnmeasured) || observed == F(kOutside), F(0.0f), off);
}

}  // namespace hypotrack::rgbd_depth::HYPOTRACK_TARGET
HYPOTRACK_PIXEL_END();

#endif
