#pragma once

#include <concepts>
#include <cstdint>

#include "hypotrack/cuda/pixel_walk.cuh"
#include "hypotrack/cuda/runtime.cuh"
#include "hypotrack/cuda/texels.cuh"

/// Residuals of a PixelObjective: its kernel runs with a Term that stores what pixel() returns.
namespace hypotrack::cuda {

/// A Term whose pixel() returns the pixel's residual.
template <class Term>
concept HasResiduals = requires(const Term& term) {
  { term.uncovered_residual(0, 0) } -> std::same_as<float>;
};

/// A Term that also has residuals of the state; they follow those of the pixels.
template <class Term>
concept HasStateResiduals = requires(const Term& term, const float* state) {
  { term.state_residual_count() } -> std::same_as<int>;
  { term.state_residual(0, state) } -> std::same_as<float>;
};

template <class Term>
__host__ __device__ inline int state_residual_count(const Term& term) {
  if constexpr (HasStateResiduals<Term>) {
    return term.state_residual_count();
  } else {
    return 0;
  }
}

/// Addresses of a batch's residuals.
struct ResidualPlaces {
  float* views[kMaxViews];  ///< of the first hypothesis; null for views without residuals
  int width[kMaxViews], height[kMaxViews];
  float* state;  ///< after those of all views
  std::int64_t stride;
  float factor;
  int bands;  ///< blocks per hypothesis

  __device__ __forceinline__ std::int64_t at_hypothesis() const {
    return stride * (blockIdx.x / static_cast<unsigned>(bands));
  }
  __device__ __forceinline__ void put(int view, int x, int y, float residual) const {
    views[view][at_hypothesis() + y * width[view] + x] = factor * residual;
  }
};

/// A Term for BlockEvaluation that also writes the residuals.
template <class Term>
struct WithResiduals : Term {
  static constexpr int kSums = Term::kSums;

  ResidualPlaces to;

  template <int kReference>
  __device__ __forceinline__ void pixel(const StereoPixel& p, float (&sums)[kSums]) const {
    to.put(kReference, p.x, p.y, Term::template pixel<kReference>(p, sums));
  }
  template <int kReference, class Texels>
  __device__ __forceinline__ void pixel(const StereoPixel& p, const Texels& texels,
                                        float (&sums)[kSums]) const {
    to.put(kReference, p.x, p.y, Term::template pixel<kReference>(p, texels, sums));
  }
  __device__ __forceinline__ void pixel(const ViewPixel& p, float (&sums)[kSums]) const {
    to.put(p.view, p.x, p.y, Term::pixel(p, sums));
  }

  /// Writes the state's residuals and returns the cost; called by one thread per hypothesis.
  __device__ __forceinline__ double cost(const double (&sums)[kSums], const float* state) const {
    if constexpr (HasStateResiduals<Term>) {
      for (int i = 0; i < Term::state_residual_count(); ++i) {
        to.state[to.at_hypothesis() + i] = to.factor * Term::state_residual(i, state);
      }
    }
    return Term::cost(sums, state);
  }
};

inline constexpr int kFillThreads = 128;

/// Writes the residuals of uncovered pixels for all hypotheses: one thread per pixel, one row of
/// blocks per view.
template <class Term>
__global__ void __launch_bounds__(kFillThreads)
    write_uncovered(const __grid_constant__ Term term, const __grid_constant__ ResidualPlaces to,
                    std::int64_t hypotheses) {
  const int view = static_cast<int>(blockIdx.y);
  const int i = static_cast<int>(blockIdx.x * kFillThreads + threadIdx.x);
  if (!to.views[view] || i >= to.width[view] * to.height[view]) return;
  const float residual = to.factor * term.uncovered_residual(view, i);
  for (std::int64_t h = 0; h < hypotheses; ++h) to.views[view][h * to.stride + i] = residual;
}

}  // namespace hypotrack::cuda
