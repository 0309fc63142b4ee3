#pragma once

#include "cuda/observe_job.hpp"
#include "depth_agreement-inl.hpp"
#include "energy.hpp"
#include "finger_pair.hpp"
#include "hypotrack/gpu/pixel_walk.cuh"
#include "pixel_penalties.hpp"

namespace hypotrack::rgbd_depth {

/// The objective's functions per pixel and per hypothesis (pixel_objective.cuh).
struct DepthTerm {
  static constexpr bool kStereo = false;
  static constexpr bool kVisitsUncovered = false;
  static constexpr int kSums = 3;  ///< closeness in m, matched, beyond

  const float* observed[cuda::kMaxViews];  ///< null for views without depth
  const Counts* counts;
  const FingerPair* fingers;
  int width[cuda::kMaxViews];  ///< of the tiles
  int view_bits;               ///< bit v: view v has depth
  int finger_count;
  float d_max, d_match;
  Weights weights;

  HYPOTRACK_PIXEL int views() const { return view_bits; }

  __device__ float pixel(const cuda::ViewPixel& p, float (&sums)[kSums]) const {
    const float here = observed[p.view][p.y * width[p.view] + p.x];
    const auto agreement = scalar::depth_agreement(p.inverse_depth, here, d_max, d_match);
    sums[0] += agreement.closeness;
    sums[1] += agreement.matched ? 1.0f : 0.0f;
    sums[2] += agreement.beyond ? 1.0f : 0.0f;
    return pixel::sqrt(penalties().wrong) * scalar::depth_residual(p.inverse_depth, here, d_max);
  }
  __device__ float uncovered_residual(int view, int i) const {
    return rgbd_depth::uncovered_residual(observed[view][i], penalties());
  }
  HYPOTRACK_PIXEL int state_residual_count() const { return finger_count; }
  __device__ float state_residual(int i, const float* state) const {
    return crossing_residual(finger_crossing(fingers + i, 1, state), weights);
  }

  __device__ double cost(const double (&sums)[kSums], const float* state) const {
    const Totals totals{static_cast<double>(counts->foreground),
                        static_cast<double>(counts->measured), sums[0], sums[1], sums[2]};
    return energy(totals, finger_crossing(fingers, finger_count, state), weights);
  }

 private:
  __device__ __forceinline__ PixelPenalties penalties() const {
    return pixel_penalties(static_cast<float>(counts->foreground), weights);
  }
};

}  // namespace hypotrack::rgbd_depth
