// Included once per instruction set: no #pragma once.
#if defined(STEREO_COLOR_COLOR_CONSISTENCY_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef STEREO_COLOR_COLOR_CONSISTENCY_INL_HPP_
#undef STEREO_COLOR_COLOR_CONSISTENCY_INL_HPP_
#else
#define STEREO_COLOR_COLOR_CONSISTENCY_INL_HPP_
#endif

#include "hypotrack/plugin/pixel.hpp"

/// The per-pixel function of the stereo_color objective, for every lane type (pixel.hpp).
HYPOTRACK_PIXEL_BEGIN();
namespace hypotrack::stereo_color::HYPOTRACK_TARGET {

/// One pixel of one view: colour channels and weight C, all in 0..1.
template <class F>
struct ColorSample {
  F channel_0, channel_1, channel_2, weight;
};

/// Parameters of the similarity of colours as a function of their distance.
template <class F>
struct SimilarityCurve {
  F beta, coverage_penalty;
  bool gaussian;
};

/// Computes the squared distance of two colours.
template <class F>
HYPOTRACK_PIXEL F squared_difference(const ColorSample<F>& left, const ColorSample<F>& right) {
  using pixel::mul_add;
  const F d0 = left.channel_0 - right.channel_0;
  const F d1 = left.channel_1 - right.channel_1;
  const F d2 = left.channel_2 - right.channel_2;
  return mul_add(d0, d0, mul_add(d1, d1, d2 * d2));
}

/// Computes the colour consistency of a surface point seen in both views: s = min(C_l, C_r)
/// (exp(-x) - coverage_penalty), x = beta ||I_l - I_r|| or its square.
template <class F>
HYPOTRACK_PIXEL F color_consistency(const ColorSample<F>& left, const ColorSample<F>& right,
                                    const SimilarityCurve<F>& curve) {
  using pixel::exp;
  using pixel::min;
  using pixel::quick_sqrt;
  const F square = squared_difference(left, right);
  const F beta = curve.beta;
  const F x = curve.gaussian ? beta * beta * square : beta * quick_sqrt(square);
  return min(left.weight, right.weight) * (exp(F(0.0f) - x) - curve.coverage_penalty);
}

/// Returns the residual of a pixel of weight C: sqrt(share (C - s)), with s = 0 unless both views
/// see it.
template <class F>
HYPOTRACK_PIXEL F color_residual(F weight, F consistency, F share) {
  using pixel::max;
  using pixel::sqrt;
  // s <= C, up to the rounding of exp().
  return sqrt(share * max(weight - consistency, F(0.0f)));
}

/// Pixels along the epipolar line, to either side of a point, over which slopes of residuals are
/// differences: few, so that they are derivatives. Over half a pixel they lead off the minimum, and
/// poses become 30 % worse.
constexpr float kSlopeReach = 0.05f;

/// Interpolates every channel: a + (b - a) t.
template <class F>
HYPOTRACK_PIXEL ColorSample<F> blend(const ColorSample<F>& a, const ColorSample<F>& b, F t) {
  using pixel::mul_add;
  return {mul_add(b.channel_0 - a.channel_0, t, a.channel_0),
          mul_add(b.channel_1 - a.channel_1, t, a.channel_1),
          mul_add(b.channel_2 - a.channel_2, t, a.channel_2),
          mul_add(b.weight - a.weight, t, a.weight)};
}

}  // namespace hypotrack::stereo_color::HYPOTRACK_TARGET
HYPOTRACK_PIXEL_END();

#endif
