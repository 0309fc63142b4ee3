#pragma once

/// Constants of a single-precision sine and cosine that is bit-identical on CPU and GPU, where the
/// library functions differ in the last digits. Used by hypotrack/gpu/pose.cuh and
/// core/src/scene/pose_kernel.cpp:
///   r = angle - n pi/2,   n = round(angle 2/pi)           in two steps (Cody and Waite)
///   sin r = r + r^3 (S3 + r^2 (S5 + r^2 (S7 + r^2 S9)))   Taylor, |r| <= pi/4
///   cos r = 1 + r^2 (C2 + r^2 (C4 + r^2 (C6 + r^2 C8)))
/// n modulo 4 selects one of the two and its sign. Error below 1e-7 for angles up to some hundreds.
namespace hypotrack::sine_cosine {

inline constexpr float kQuartersPerRadian = 0.636619772f;  // 2/pi
inline constexpr float kQuarterHigh = 1.57079637f;         // pi/2
inline constexpr float kQuarterLow = -4.37113883e-8f;      // pi/2 - kQuarterHigh
/// Adding it rounds a float: the nearest integer is then in its last bits.
inline constexpr float kRoundingBias = 12582912.0f;  // 1.5 * 2^23
inline constexpr float kS3 = -1.66666667e-1f;
inline constexpr float kS5 = 8.33333333e-3f;
inline constexpr float kS7 = -1.98412698e-4f;
inline constexpr float kS9 = 2.75573192e-6f;
inline constexpr float kC2 = -0.5f;
inline constexpr float kC4 = 4.16666667e-2f;
inline constexpr float kC6 = -1.38888889e-3f;
inline constexpr float kC8 = 2.48015873e-5f;

}  // namespace hypotrack::sine_cosine
