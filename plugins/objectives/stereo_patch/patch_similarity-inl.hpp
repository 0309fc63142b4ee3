// Included once per instruction set: no #pragma once.
#if defined(STEREO_PATCH_PATCH_SIMILARITY_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef STEREO_PATCH_PATCH_SIMILARITY_INL_HPP_
#undef STEREO_PATCH_PATCH_SIMILARITY_INL_HPP_
#else
#define STEREO_PATCH_PATCH_SIMILARITY_INL_HPP_
#endif

#include "hypotrack/plugin/pixel.hpp"

/// The per-pixel functions of the stereo_patch objective, for every lane type (pixel.hpp).
HYPOTRACK_PIXEL_BEGIN();
namespace hypotrack::stereo_patch::HYPOTRACK_TARGET {

/// Mean and variance (plus the floor) of a patch.
template <class F>
struct Moments {
  F mean, variance;
};

template <class F>
HYPOTRACK_PIXEL Moments<F> moments(F mean, F mean_of_square, F floor) {
  using pixel::max;
  return {mean, max(mean_of_square - mean * mean, F(0.0f)) + floor};
}

/// Computes the correlation of two patches with a variance floor e: z = cov(a, b) / sqrt((var a +
/// e)(var b + e)).
template <class F>
HYPOTRACK_PIXEL F correlation(F mean_of_product, const Moments<F>& a, const Moments<F>& b) {
  using pixel::sqrt;
  return (mean_of_product - a.mean * b.mean) / sqrt(a.variance * b.variance);
}

/// Computes s = exp(-sharpness (1 - z)). It is 0 where z is NaN, as where a patch extends beyond an
/// image.
template <class F>
HYPOTRACK_PIXEL F similarity(F z, F sharpness) {
  using pixel::exp;
  using pixel::min;
  using pixel::select;
  const F s = exp(sharpness * (min(z, F(1.0f)) - F(1.0f)));
  return select(z >= F(-2.0f), s, F(0.0f));
}

/// Position of an inverse depth between the planes: the one before it and the fraction to the next.
template <class F>
struct PlaneShare {
  F before, share;
};

/// Splits `position` = (inverse depth - first) / step. Meaningful only if between_planes().
template <class F>
HYPOTRACK_PIXEL PlaneShare<F> plane_share(F position, F last) {
  using pixel::floor;
  using pixel::max;
  using pixel::min;
  const F before = min(max(floor(position), F(0.0f)), last - F(1.0f));
  return {before, position - before};
}

/// Returns the residual of a pixel: sqrt(weight - s), with s = 0 unless both views see it between
/// the planes. `weight` and `s` include the pixel's weight.
template <class F>
HYPOTRACK_PIXEL F patch_residual(F weight, F similarity) {
  using pixel::max;
  using pixel::sqrt;
  return sqrt(max(weight - similarity, F(0.0f)));
}

/// Returns whether a position lies from the first plane (0) to the last.
template <class F>
HYPOTRACK_PIXEL auto between_planes(F position, F last) {
  return position >= F(0.0f) && position <= last;
}

}  // namespace hypotrack::stereo_patch::HYPOTRACK_TARGET
HYPOTRACK_PIXEL_END();

#endif
