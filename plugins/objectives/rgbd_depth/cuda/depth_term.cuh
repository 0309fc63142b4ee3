#pragma once

#include "cuda/observe_job.hpp"
#include "depth_agreement-inl.hpp"
#include "energy.hpp"
#include "finger_pair.hpp"
#include "hypotrack/cuda/pixel_walk.cuh"

namespace hypotrack::rgbd_depth {

/// The objective's part for one pixel and for one hypothesis (pixel_objective.cuh).
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

  __device__ int views() const { return view_bits; }

  __device__ void pixel(const cuda::ViewPixel& p, float (&sums)[kSums]) const {
    const float here = observed[p.view][p.y * width[p.view] + p.x];
    const auto agreement = scalar::depth_agreement(p.inverse_depth, here, d_max, d_match);
    sums[0] += agreement.closeness;
    sums[1] += agreement.matched ? 1.0f : 0.0f;
    sums[2] += agreement.beyond ? 1.0f : 0.0f;
  }

  __device__ double cost(const double (&sums)[kSums], const float* state) const {
    const Totals totals{static_cast<double>(counts->foreground),
                        static_cast<double>(counts->measured), sums[0], sums[1], sums[2]};
    return energy(totals, finger_crossing(fingers, finger_count, state), weights);
  }
};

}  // namespace hypotrack::rgbd_depth
