#ifndef HYPOTRACK_PIXEL_HPP_  // no #pragma once: the last lines are for every inclusion
#define HYPOTRACK_PIXEL_HPP_

#include <cmath>
#include <cstdint>
#include <cstring>

/// Operations for per-pixel functions. Such a function is written once, as a template over the lane
/// type, and compiled for
///   float   one pixel at a time: plain C++ and, under nvcc, device code;
///   Lanes   a whole SIMD vector of pixels (hypotrack/plugin/simd-inl.hpp), once per instruction
///   set.
/// Both types have the same operations: + - * /, comparisons (which give a mask: bool or LaneMask),
/// && || ! on masks, min, max, abs, sqrt, quick_sqrt, floor, round, exp, mul_add and select. Use
/// `select(mask, a, b)` instead of branches. Masks do not short-circuit.
///
/// The example below is a header with a per-pixel function (my_term-inl.hpp). Sources that use
/// Highway's foreach_target (simd-inl.hpp) compile it for vectors, once per instruction set. All
/// others, CUDA included, compile it for float.
///
///   #if defined(MY_TERM_INL_HPP_) == defined(HWY_TARGET_TOGGLE)  // once per instruction set
///   #ifdef MY_TERM_INL_HPP_
///   #undef MY_TERM_INL_HPP_
///   #else
///   #define MY_TERM_INL_HPP_
///   #endif
///   #include "hypotrack/plugin/pixel.hpp"
///   HYPOTRACK_PIXEL_BEGIN();
///   namespace my::HYPOTRACK_TARGET {
///   template <class F>
///   HYPOTRACK_PIXEL F closeness(F a, F b) {
///     using hypotrack::pixel::abs;  // the scalar one; that of Lanes is found by its argument
///     using hypotrack::pixel::exp;
///     return exp(F(0) - abs(a - b));
///   }
///   }  // namespace my::HYPOTRACK_TARGET
///   HYPOTRACK_PIXEL_END();
///   #endif
///
/// This header includes neither Eigen, OpenCV nor Highway, so that CUDA code can include it.

/// Precedes every per-pixel function.
#if defined(__CUDACC__)
#include "hypotrack/gpu/instructions.cuh"
#define HYPOTRACK_PIXEL __host__ __device__ __forceinline__
#else
#define HYPOTRACK_PIXEL inline __attribute__((always_inline))
#endif

/// Enclose per-pixel functions and name their namespace. simd-inl.hpp redefines the three macros,
/// so that each instruction set has its own functions.
#ifndef HYPOTRACK_TARGET
#define HYPOTRACK_TARGET scalar
#define HYPOTRACK_PIXEL_BEGIN() static_assert(true, "")
#define HYPOTRACK_PIXEL_END() static_assert(true, "")
#endif

namespace hypotrack {

/// Maps a pixel of one view with its inverse depth to another view. With p = (x, y, 1) and w = 1/z:
///   q = a2 . p + b2 w,   u = (a0 . p + b0 w) / q,   v = (a1 . p + b1 w) / q,   1/z_other = w / q
/// where A = K_to R K_from^-1 and b = K_to t for to_from = (R, t). For a rectified pair R = 1 and t
/// = (t_x, 0, 0), so that q = 1, v = y and u = x + a[0][2] + b0 w: linear in 1/z, same row.
struct StereoMap {
  float a[3][3];
  float b[3];
  int width;  ///< of the other view's tile, pixels
  int height;
  bool rectified;
};

namespace pixel {

// exp(x) = 2^n exp(r) with n = round(x / ln 2) and |r| <= ln 2 / 2. exp(r) is its Taylor polynomial
// of degree 6 with the last coefficient fitted to the interval: relative error below 3e-7. All lane
// types use the same constants and order of operations, so they agree up to rounding. GPUs use
// their own 2^x, which is as accurate.
inline constexpr float kExpLowest = -80.0f;  // below, exp() is exp(-80) = 1.8e-35
inline constexpr float kExpHighest = 88.0f;
inline constexpr float kLog2E = 1.44269504f;
inline constexpr float kLn2High = 0.693359375f;  // few bits, so that n * kLn2High is exact
inline constexpr float kLn2Low = -2.12194440e-4f;
inline constexpr float kExp2 = 0.5f;
inline constexpr float kExp3 = 0.166666667f;
inline constexpr float kExp4 = 0.0416666667f;
inline constexpr float kExp5 = 0.00833333333f;
inline constexpr float kExp6 = 0.00139f;

HYPOTRACK_PIXEL float min(float a, float b) { return b < a ? b : a; }
HYPOTRACK_PIXEL float max(float a, float b) { return a < b ? b : a; }
HYPOTRACK_PIXEL float abs(float a) { return std::fabs(a); }
HYPOTRACK_PIXEL float sqrt(float a) { return std::sqrt(a); }
/// Returns the square root within 3e-7 relative; may return 0 for subnormal numbers.
HYPOTRACK_PIXEL float quick_sqrt(float a) {
#if defined(__CUDA_ARCH__)
  return cuda::approximate_sqrt(a);
#else
  return std::sqrt(a);
#endif
}
HYPOTRACK_PIXEL float floor(float a) { return std::floor(a); }
/// Returns a * b + c, rounded once on a GPU and on CPUs with vector FMA, else once or twice.
HYPOTRACK_PIXEL float mul_add(float a, float b, float c) {
#if defined(__CUDA_ARCH__)
  return fmaf(a, b, c);
#else
  return a * b + c;
#endif
}
HYPOTRACK_PIXEL float select(bool mask, float yes, float no) { return mask ? yes : no; }
/// Returns the nearest integer, ties to even.
HYPOTRACK_PIXEL float round(float a) { return std::nearbyint(a); }

/// Returns e^x within 5e-7 relative for -80 <= x <= 88; clamps x to that range.
HYPOTRACK_PIXEL float exp(float x) {
  x = min(max(x, kExpLowest), kExpHighest);
#if defined(__CUDA_ARCH__)
  // 2^(high + low) with the device's own 2^high; low is the rounding error of high.
  constexpr float kLn2 = 0.693147181f, kLog2ERest = 1.92596299e-8f;
  const float high = x * kLog2E;
  const float low = fmaf(x, kLog2ERest, fmaf(x, kLog2E, -high));
  const float power = cuda::approximate_exp2(high);
  return fmaf(power, low * kLn2, power);
#else
  const float n = round(x * kLog2E);
  const float r = mul_add(n, -kLn2Low, mul_add(n, -kLn2High, x));
  float p = mul_add(kExp6, r, kExp5);
  p = mul_add(p, r, kExp4);
  p = mul_add(p, r, kExp3);
  p = mul_add(p, r, kExp2);
  p = mul_add(p * r, r, r) + 1.0f;
  const std::int32_t bits = (static_cast<std::int32_t>(n) + 127) << 23;
  float scale;
  std::memcpy(&scale, &bits, sizeof scale);
  return p * scale;
#endif
}

}  // namespace pixel

/// Packs two numbers, clamped to 0 .. 1, as 16-bit fractions into one word. unorm16_low() and
/// unorm16_high() (simd-inl.hpp) unpack them. Exact for 8-bit values (k / 255).
HYPOTRACK_PIXEL std::uint32_t pack_unorm16(float low, float high) {
  const auto bits = [](float x) {
    return static_cast<std::uint32_t>(pixel::min(pixel::max(x, 0.0f), 1.0f) * 65535.0f + 0.5f);
  };
  return bits(low) | bits(high) << 16;
}

/// An 8-bit BGR pixel for CPU and CUDA code.
struct Bgr {
  std::uint8_t b, g, r;
};

/// Returns the ITU-R BT.601 luma of a pixel, 0 to 1.
HYPOTRACK_PIXEL float gray_level(Bgr p) {
  return (0.299f * static_cast<float>(p.r) + 0.587f * static_cast<float>(p.g) +
          0.114f * static_cast<float>(p.b)) /
         255.0f;
}

}  // namespace hypotrack

#endif  // HYPOTRACK_PIXEL_HPP_

// In a SIMD source, the code below this include belongs to its current instruction set.
#ifdef HWY_TARGET_INCLUDE
#include "hypotrack/plugin/simd-inl.hpp"
#endif
