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

  const std::uint32_t* words;  ///< Volume::words, device memory
  const Planes* planes;        ///< device memory: another one in every frame
  int width;                   ///< of the first view's tile
  float tolerance;

  __device__ int directions() const { return 1; }

  template <int kReference>
  __device__ void pixel(const cuda::StereoPixel& p, float (&sums)[kSums]) const {
    if (!p.seen) return;
    const Planes known = *planes;
    const auto last = static_cast<float>(known.count - 1);
    const float position = (p.inverse_depth - known.first) * (1.0f / known.step);
    if (!scalar::between_planes(position, last)) return;
    const auto at = scalar::plane_share(position, last);
    const std::uint32_t pair =
        words[(p.y * known.count + static_cast<int>(at.before)) * width + p.x];
    const float before = cuda::exact_low_half(pair), after = cuda::exact_high_half(pair);
    sums[0] += pixel::mul_add(after - before, at.share, before) * kUnit;
  }

  __device__ double cost(const double (&sums)[kSums], const float*) const {
    return 0.0 - sums[0];  // not -0.0
  }
};

}  // namespace hypotrack::stereo_patch
