#pragma once

#include <cstdint>

#include "hypotrack/cuda/pixel_walk.cuh"
#include "patch_similarity-inl.hpp"
#include "planes_layout.hpp"

namespace hypotrack::stereo_patch {

/// The objective's sum over pixels (hypotrack/cuda/pixel_objective.cuh).
struct PatchTerm {
  static constexpr bool kStereo = true;
  static constexpr bool kVisitsUncovered = false;
  static constexpr int kSums = 1;
  static constexpr float kUnit = 1.0f / 65535.0f;

  const std::uint32_t* words;   ///< Volume::words, device memory
  const Planes* planes;         ///< device memory: new values in every frame
  const std::uint32_t* pixels;  ///< of the first view's tile
  std::uint32_t counting;       ///< flags that a pixel with weight must have
  float share, root;            ///< weight of these pixels (share_of()), and its square root
  int width;                    ///< of that tile
  float tolerance;

  HYPOTRACK_PIXEL int directions() const { return 1; }

  template <int kReference>
  __device__ float pixel(const cuda::StereoPixel& p, float (&sums)[kSums]) const {
    const float s = p.seen ? similarity(p) : 0.0f;
    sums[0] += s;
    return scalar::patch_residual(counts(p.y * width + p.x) ? share : 0.0f, s);
  }
  __device__ float uncovered_residual(int, int i) const { return counts(i) ? root : 0.0f; }

  __device__ double cost(const double (&sums)[kSums], const float*) const {
    return 0.0 - sums[0];  // not -0.0
  }

 private:
  __device__ __forceinline__ bool counts(int i) const { return (pixels[i] & counting) == counting; }
  __device__ __forceinline__ float similarity(const cuda::StereoPixel& p) const {
    const Planes known = *planes;
    const auto last = static_cast<float>(known.count - 1);
    const float position = (p.inverse_depth - known.first) * (1.0f / known.step);
    if (!scalar::between_planes(position, last)) return 0.0f;
    const auto at = scalar::plane_share(position, last);
    const std::uint32_t pair =
        words[(p.y * known.count + static_cast<int>(at.before)) * width + p.x];
    const float before = cuda::exact_low_half(pair), after = cuda::exact_high_half(pair);
    return pixel::mul_add(after - before, at.share, before) * (kUnit * share);
  }
};

}  // namespace hypotrack::stereo_patch
