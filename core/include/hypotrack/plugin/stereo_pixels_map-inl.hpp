// Included once per instruction set: no #pragma once.
#if defined(HYPOTRACK_STEREO_PIXELS_MAP_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef HYPOTRACK_STEREO_PIXELS_MAP_INL_HPP_
#undef HYPOTRACK_STEREO_PIXELS_MAP_INL_HPP_
#else
#define HYPOTRACK_STEREO_PIXELS_MAP_INL_HPP_
#endif

#include "hypotrack/plugin/pixel.hpp"

/// Per-pixel functions that map a surface point to the other view and test whether it is visible
/// there. They accept every lane type (pixel.hpp).
HYPOTRACK_PIXEL_BEGIN();
namespace hypotrack::HYPOTRACK_TARGET {

/// A surface point in the other view.
template <class F>
struct Mapped {
  F u, v;           ///< pixels
  F inverse_depth;  ///< of this point in the other view; negative or infinite behind its camera
};

/// Returns a . (x, y, 1) + b w.
template <class F>
HYPOTRACK_PIXEL F affine(const float (&a)[3], float b, F x, F y, F w) {
  using pixel::mul_add;
  return mul_add(F(b), w, mul_add(F(a[0]), x, mul_add(F(a[1]), y, F(a[2]))));
}

/// Maps pixel (x, y) with inverse depth w by the equations of StereoMap.
template <bool kRectified, class F>
HYPOTRACK_PIXEL Mapped<F> map_pixel(const StereoMap& map, F x, F y, F w) {
  using pixel::mul_add;
  if constexpr (kRectified) {
    return {mul_add(F(map.b[0]), w, x + F(map.a[0][2])), y, w};
  } else {
    const F u = affine<F>(map.a[0], map.b[0], x, y, w);
    const F v = affine<F>(map.a[1], map.b[1], x, y, w);
    const F inverse = F(1.0f) / affine<F>(map.a[2], map.b[2], x, y, w);
    return {u * inverse, v * inverse, w * inverse};
  }
}

/// Returns true if the nearest pixel lies within the other view's tile, in front of its camera.
template <bool kRectified, class F>
HYPOTRACK_PIXEL auto lands_inside(const StereoMap& map, const Mapped<F>& m) {
  const F low(-0.5f);
  const auto column = m.u >= low && m.u < F(static_cast<float>(map.width) - 0.5f);
  if constexpr (kRectified) {
    return column;
  } else {
    const auto row = m.v >= low && m.v < F(static_cast<float>(map.height) - 0.5f);
    return column && row && m.inverse_depth > F(0.0f);
  }
}

/// Returns true if two inverse depths belong to one surface: |1/a - 1/b| <= r. Requires `a` > 0; b
/// = 0 (nothing) never matches.
template <class F>
HYPOTRACK_PIXEL auto same_depth(F a, F b, F r) {
  using pixel::abs;
  return abs(a - b) <= r * a * b;
}

/// Motion of a surface point in the other view as its 1/z grows.
template <class F>
struct EpipolarMotion {
  F along_u, along_v;  ///< direction, of length 1
  F speed;             ///< pixels per 1/m
};

/// Computes the motion of the point that map_pixel() maps to (u, v). With q = a2 . (x, y, 1) + b2
/// w, du/dw = (b0 - u b2) / q and dv/dw = (b1 - v b2) / q.
template <class F>
HYPOTRACK_PIXEL EpipolarMotion<F> epipolar_motion(const StereoMap& map, F x, F y, F w, F u, F v) {
  using pixel::max;
  using pixel::sqrt;
  if (map.rectified) {
    return {F(map.b[0] < 0 ? -1.0f : 1.0f), F(0.0f), F(map.b[0] < 0 ? -map.b[0] : map.b[0])};
  }
  const F q = affine<F>(map.a[2], map.b[2], x, y, w);
  const F du = (F(map.b[0]) - u * F(map.b[2])) / q, dv = (F(map.b[1]) - v * F(map.b[2])) / q;
  const F speed = max(sqrt(du * du + dv * dv), F(1e-6f));
  return {du / speed, dv / speed, speed};
}

}  // namespace hypotrack::HYPOTRACK_TARGET
HYPOTRACK_PIXEL_END();

#endif
