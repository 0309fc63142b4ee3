#pragma once

#include <cstdint>

#include "hypotrack/gpu/pixel_walk.cuh"
#include "patch_similarity-inl.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

/// The objective's sum over pixels (hypotrack/gpu/pixel_objective.cuh).
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
    const float s = p.seen ? similarity(p, 0.0f) : 0.0f;
    sums[0] += s;
    return scalar::patch_residual(counts(p.y * width + p.x) ? share : 0.0f, s);
  }
  __device__ float uncovered_residual(int, int i) const { return counts(i) ? root : 0.0f; }

  /// Differences over half a plane to either side, as on the CPU.
  template <int kReference, class Texels>
  __device__ float slope(const cuda::StereoPixel& p, const StereoMap&, const Texels&) const {
    constexpr float kReach = 0.5f;
    const Planes known = *planes;
    if (!p.seen || !scalar::between_planes(position_of(p, known), last_of(known))) return 0.0f;
    const float most = counts(p.y * width + p.x) ? share : 0.0f;
    return (scalar::patch_residual(most, similarity(p, kReach)) -
            scalar::patch_residual(most, similarity(p, -kReach))) *
           (0.5f / kReach / known.step);
  }

  __device__ double cost(const double (&sums)[kSums], const float*) const {
    return 0.0 - sums[0];  // not -0.0
  }

 private:
  __device__ __forceinline__ bool counts(int i) const { return (pixels[i] & counting) == counting; }
  __device__ __forceinline__ static float last_of(const Planes& known) {
    return static_cast<float>(known.count - 1);
  }
  __device__ __forceinline__ static float position_of(const cuda::StereoPixel& p,
                                                      const Planes& known) {
    return (p.inverse_depth - known.first) * (1.0f / known.step);
  }
  /// Returns the similarity `beside` planes nearer than the surface; 0 if that is not between
  /// planes.
  __device__ __forceinline__ float similarity(const cuda::StereoPixel& p, float beside) const {
    const Planes known = *planes;
    const float last = last_of(known), position = position_of(p, known);
    if (!scalar::between_planes(position, last)) return 0.0f;
    const auto at =
        scalar::plane_share(pixel::min(pixel::max(position + beside, 0.0f), last), last);
    const std::uint32_t pair =
        words[(p.y * known.count + static_cast<int>(at.before)) * width + p.x];
    const float before = cuda::exact_low_half(pair), after = cuda::exact_high_half(pair);
    return pixel::mul_add(after - before, at.share, before) * (kUnit * share);
  }
};

}  // namespace hypotrack::stereo_patch
