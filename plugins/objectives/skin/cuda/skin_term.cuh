#pragma once

#include <cstdint>

#include "coverage-inl.hpp"
#include "hypotrack/gpu/pixel_walk.cuh"
#include "uncovered_residual.hpp"

namespace hypotrack::skin {

/// The objective's functions per pixel and per hypothesis (hypotrack/gpu/pixel_objective.cuh).
struct SkinTerm {
  static constexpr bool kStereo = false;
  static constexpr bool kVisitsUncovered = false;
  static constexpr int kSums = 1;  ///< of change_if_covered()

  const std::uint32_t* foreground[cuda::kMaxViews];  ///< null for unused views
  const unsigned long long* uncovered;  ///< cost of a hypothesis that covers nothing, in 1 / 65535
  int width[cuda::kMaxViews];           ///< of the tiles
  int view_bits;                        ///< bit v: view v is used
  int view_count;                       ///< number of used views
  float spill;

  static constexpr float kUnit = 1.0f / 65535.0f;

  HYPOTRACK_PIXEL int views() const { return view_bits; }

  __device__ float pixel(const cuda::ViewPixel& p, float (&sums)[kSums]) const {
    const std::uint32_t here = foreground[p.view][p.y * width[p.view] + p.x];
    const float background = cuda::exact_high_half(here) * kUnit;
    sums[0] += scalar::change_if_covered(cuda::exact_low_half(here) * kUnit, background, spill);
    return scalar::covered_residual(background, spill, share());
  }
  __device__ float uncovered_residual(int view, int i) const {
    return skin::uncovered_residual(cuda::exact_low_half(foreground[view][i]) * kUnit, share());
  }
  /// The residual does not depend on the depth of what is drawn.
  __device__ float slope(const cuda::ViewPixel&) const { return 0.0f; }
  __device__ float share() const { return 1.0f / static_cast<float>(view_count); }

  __device__ double cost(const double (&sums)[kSums], const float*) const {
    return (static_cast<double>(*uncovered) / 65535 + sums[0]) / view_count;
  }
};

}  // namespace hypotrack::skin
