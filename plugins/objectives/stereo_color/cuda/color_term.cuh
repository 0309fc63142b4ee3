#pragma once

#include <cstdint>

#include "color_consistency-inl.hpp"
#include "cuda/feature_job.hpp"
#include "hypotrack/gpu/pixel_walk.cuh"
#include "settings.hpp"

namespace hypotrack::stereo_color {

/// The objective's sums over pixels (hypotrack/gpu/pixel_objective.cuh).
template <bool kBilinear, bool kBoth>
struct ColorTerm {
  static constexpr bool kStereo = true;
  static constexpr bool kVisitsUncovered = false;
  static constexpr int kSums = kBoth ? 6 : 3;  // per direction: similarity, seen, rendered
  static constexpr float kUnit = 1.0f / 65535.0f;

  using Texel = PackedFeatures;

  const PackedFeatures* features[2];     ///< per view, device memory
  scalar::SimilarityCurve<float> curve;  ///< beta per kUnit of colour
  float tolerance;
  Direction direction;
  Aggregation aggregation;

  HYPOTRACK_PIXEL int directions() const {
    if (kBoth) return 3;
    return direction == Direction::left_to_right ? 1 : 2;
  }
  __device__ const Texel* texels(int view) const { return features[view]; }

  template <int kReference, class Texels>
  __device__ float pixel(const cuda::StereoPixel& p, const Texels& texels,
                         float (&sums)[kSums]) const {
    constexpr int kFirst = kBoth ? 3 * kReference : 0;
    // Load before it is known to be needed, so that nothing waits for it.
    const Texel here = texels.template at<kReference>(p.x, p.y);
    sums[kFirst + 2] += 1.0f;
    if (!p.seen) return residual(here, 0.0f);
    sums[kFirst + 1] += 1.0f;
    const float s = consistency(
        here, [&](int x, int y) { return texels.template at<1 - kReference>(x, y); }, p);
    sums[kFirst] += s;
    return residual(here, s);
  }
  __device__ float uncovered_residual(int view, int i) const {
    return residual(features[view][i], 0.0f);
  }

  /// Differences to either side along the epipolar line, as on the CPU.
  template <int kReference, class Texels>
  __device__ float slope(const cuda::StereoPixel& p, const StereoMap& map,
                         const Texels& texels) const {
    if (!p.seen) return 0.0f;
    constexpr float kReach = scalar::kSlopeReach;
    const Texel here = texels.template at<kReference>(p.x, p.y);
    const auto there = [&](int x, int y) { return texels.template at<1 - kReference>(x, y); };
    const auto motion = hypotrack::scalar::epipolar_motion<float>(
        map, static_cast<float>(p.x), static_cast<float>(p.y), p.inverse_depth, p.u, p.v);
    const auto residual_at = [&](float reach) {
      cuda::StereoPixel moved = p;
      moved.u = fmaf(motion.along_u, reach, p.u);
      moved.v = fmaf(motion.along_v, reach, p.v);
      return residual(here, scalar::color_consistency(sample(here), blended(there, moved), curve));
    };
    return (residual_at(kReach) - residual_at(-kReach)) * motion.speed * (0.5f / kReach);
  }

  __device__ double cost(const double (&sums)[kSums], const float*) const {
    const double first = aggregate(aggregation, sums[0], sums[1], sums[2]);
    if constexpr (!kBoth) return 0.0 - first;  // not -0.0
    return 0.0 - 0.5 * (first +
                        aggregate(aggregation, sums[kSums - 3], sums[kSums - 2], sums[kSums - 1]));
  }

 private:
  using Sample = scalar::ColorSample<float>;  // colours in kUnit: beta is per kUnit

  __device__ __forceinline__ static float residual(const Texel& here, float consistency) {
    return scalar::color_residual(cuda::exact_high_half(here.channel_2_weight) * kUnit, consistency,
                                  kBoth ? 0.5f : 1.0f);
  }

  template <class There>
  __device__ __forceinline__ float consistency(const Texel& here, const There& there,
                                               const cuda::StereoPixel& p) const {
    if constexpr (kBilinear) {
      return scalar::color_consistency(sample(here), blended(there, p), curve);
    } else {
      // Only differences of colours count, so both may keep the bias.
      return scalar::color_consistency(biased(here), biased(there(p.column, p.row)), curve);
    }
  }

  __device__ __forceinline__ static Sample sample(const Texel& t) {
    using cuda::exact_high_half, cuda::exact_low_half;
    return {exact_low_half(t.channels_01), exact_high_half(t.channels_01),
            exact_low_half(t.channel_2_weight), exact_high_half(t.channel_2_weight) * kUnit};
  }
  /// Samples with kHalfBias added to every channel.
  __device__ __forceinline__ static Sample biased(const Texel& t) {
    using cuda::biased_high_half, cuda::biased_low_half;
    return {biased_low_half(t.channels_01), biased_high_half(t.channels_01),
            biased_low_half(t.channel_2_weight), cuda::exact_high_half(t.channel_2_weight) * kUnit};
  }

  /// Interpolates between the pixels around p.u, p.v.
  template <class There>
  __device__ __forceinline__ static Sample blended(const There& there, const cuda::StereoPixel& p) {
    const float x0 = corner(p.u, p.width), fx = share(p.u, x0);
    const int x = static_cast<int>(x0);
    const auto row = [&](int y) {
      return scalar::blend(sample(there(x, y)), sample(there(x + 1, y)), fx);
    };
    if (p.same_row) return row(p.row);
    const float y0 = corner(p.v, p.height);
    const int y = static_cast<int>(y0);
    return scalar::blend(row(y), row(y + 1), share(p.v, y0));
  }
  // Pixel before a position, and share of the one after it, clamped to the tile.
  __device__ static float corner(float at, int size) {
    return pixel::min(pixel::max(floorf(at), 0.0f), static_cast<float>(size - 2));
  }
  __device__ static float share(float at, float before) {
    return pixel::min(pixel::max(at - before, 0.0f), 1.0f);
  }
};

}  // namespace hypotrack::stereo_color
