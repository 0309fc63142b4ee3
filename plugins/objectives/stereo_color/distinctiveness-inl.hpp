#pragma once

#include <cmath>

#include "hypotrack/plugin/pixel.hpp"

/// Arithmetic of the distinctiveness map, one pixel at a time, for the CPU and for CUDA. Without
/// fused multiply-adds both give the same bits, up to atan and exp.
namespace hypotrack::stereo_color {

// Keeps the logarithm finite where the image is flat.
inline constexpr float kLogGuard = 1e-12f;

HYPOTRACK_PIXEL float central_difference(float before, float after) {
  return 0.5f * (after - before);
}

/// Sums three neighbours of each of three rows.
HYPOTRACK_PIXEL float sum_3x3(const float* a, const float* b, const float* c) {
  return (a[0] + a[1] + a[2]) + (b[0] + b[1] + b[2]) + (c[0] + c[1] + c[2]);
}

/// Eigenvalues of the auto-correlation matrix, major >= minor >= 0.
struct Curvature {
  float major, minor;
};

/// Computes the eigenvalues from the sums of gx gx, gx gy and gy gy.
HYPOTRACK_PIXEL Curvature curvature(float xx, float xy, float yy) {
  const float mean = 0.5f * (xx + yy);
  const float half = 0.5f * (xx - yy);
  const float radius = pixel::sqrt(half * half + xy * xy);
  return {mean + radius, pixel::max(mean - radius, 0.0f)};  // rounding can make it negative
}

/// Texture of a pixel as norm = exp(d) and ratio = tan(a). They order the pixels as d and a do, so
/// medians can be found on them. The sigmoid of d then needs neither logarithm nor exponential:
///   1 / (1 + exp(m - d)) = exp(d) / (exp(d) + exp(m)).
struct Texture {
  float norm, ratio;
};

HYPOTRACK_PIXEL Texture texture(const Curvature& c) {
  return {pixel::sqrt(c.major * c.major + c.minor * c.minor) + kLogGuard,
          c.major > 0.0f ? c.minor / c.major : 0.0f};
}

/// Lower and upper median of the valid pixels' values; equal for an odd count.
struct MedianPair {
  float low, high;
};

/// Medians as exp(m_d) and m_a.
struct Medians {
  float exp_d, a;
};

HYPOTRACK_PIXEL Medians medians(const MedianPair& norm, const MedianPair& ratio) {
  return {pixel::sqrt(norm.low) * pixel::sqrt(norm.high),
          0.5f * (std::atan(ratio.low) + std::atan(ratio.high))};
}

/// Computes c = d_s a_s, 0 below w_t.
HYPOTRACK_PIXEL float distinctiveness(const Texture& t, const Medians& m, float w_t) {
  const float d_s = t.norm / (t.norm + m.exp_d);
  const float a_s = 1.0f / (1.0f + std::exp(m.a - std::atan(t.ratio)));
  const float product = d_s * a_s;
  return product < w_t ? 0.0f : product;
}

}  // namespace hypotrack::stereo_color
