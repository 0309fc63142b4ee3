#pragma once

#include <cstdint>

#include "aggregation-inl.hpp"
#include "color_consistency-inl.hpp"
#include "cuda/feature_job.hpp"
#include "hypotrack/cuda/pixel_walk.cuh"
#include "settings.hpp"

namespace hypotrack::stereo_color {

/// The objective's sums over pixels (hypotrack/cuda/pixel_objective.cuh).
template <bool kBilinear, bool kBoth>
struct ColorTerm {
  static constexpr bool kStereo = true;
  static constexpr bool kVisitsUncovered = false;
  static constexpr int kSums = kBoth ? 6 : 3;  // per direction: similarity, seen, rendered
  static constexpr float kUnit = 1.0f / 65535.0f;

  const PackedFeatures* features[2];  ///< per view, device memory
  std::int32_t width[2];              ///< of the views' tiles
  float beta;                         ///< per kUnit of colour
  float tolerance;
  Direction direction;
  Aggregation aggregation;

  __device__ int directions() const {
    if (kBoth) return 3;
    return direction == Direction::left_to_right ? 1 : 2;
  }

  template <int kReference>
  __device__ void pixel(const cuda::StereoPixel& p, float (&sums)[kSums]) const {
    constexpr int kFirst = kBoth ? 3 * kReference : 0;
    const Sample here = load<kReference>(p.x, p.y);  // before it is known to be needed: no waiting
    sums[kFirst + 2] += 1.0f;
    if (!p.seen) return;
    sums[kFirst + 1] += 1.0f;
    sums[kFirst] += scalar::color_consistency(here, there<1 - kReference>(p), beta);
  }

  __device__ double cost(const double (&sums)[kSums], const float*) const {
    const double first = aggregate(aggregation, sums[0], sums[1], sums[2]);
    if constexpr (!kBoth) return 0.0 - first;  // not -0.0
    return 0.0 - 0.5 * (first +
                        aggregate(aggregation, sums[kSums - 3], sums[kSums - 2], sums[kSums - 1]));
  }

 private:
  using Sample = scalar::ColorSample<float>;  // colours in kUnit: beta is, too

  template <int kView>
  __device__ __forceinline__ Sample load(int x, int y) const {
    const auto* from = reinterpret_cast<const uint2*>(features[kView]) + (y * width[kView] + x);
    const uint2 words = __ldg(from);
    return {low(words.x), high(words.x), low(words.y), high(words.y) * kUnit};
  }
  // 2^23 + k as a float has k in its lower bits: cheaper than a conversion.
  __device__ static float low(std::uint32_t word) {
    return __uint_as_float(__byte_perm(word, 0x4B000000u, 0x7610)) - 8388608.0f;
  }
  __device__ static float high(std::uint32_t word) {
    return __uint_as_float(__byte_perm(word, 0x4B000000u, 0x7632)) - 8388608.0f;
  }

  template <int kView>
  __device__ __forceinline__ Sample there(const cuda::StereoPixel& p) const {
    if constexpr (!kBilinear) return load<kView>(p.column, p.row);
    const float x0 = corner(p.u, p.width), fx = share(p.u, x0);
    const int x = static_cast<int>(x0);
    const auto row = [&](int y) {
      return scalar::blend(load<kView>(x, y), load<kView>(x + 1, y), fx);
    };
    if (p.same_row) return row(p.row);
    const float y0 = corner(p.v, p.height);
    const int y = static_cast<int>(y0);
    return scalar::blend(row(y), row(y + 1), share(p.v, y0));
  }
  // The neighbours before a position and the share of those after it, clamped to the tile.
  __device__ static float corner(float at, int size) {
    return pixel::min(pixel::max(floorf(at), 0.0f), static_cast<float>(size - 2));
  }
  __device__ static float share(float at, float before) {
    return pixel::min(pixel::max(at - before, 0.0f), 1.0f);
  }
};

}  // namespace hypotrack::stereo_color
