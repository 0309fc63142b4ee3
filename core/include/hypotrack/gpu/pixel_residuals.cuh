#pragma once

#include <concepts>
#include <cstdint>

#include "hypotrack/gpu/layout.hpp"

/// Residuals of a PixelObjective's Term, and where they are stored.
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

/// Returns the views whose pixels a Term visits: bit v for view v.
template <class Term>
__host__ __device__ inline int views_of(const Term& term) {
  if constexpr (Term::kStereo) {
    return term.directions();
  } else {
    return term.views();
  }
}

/// Addresses of a batch's residuals.
struct ResidualPlaces {
  float* views[kMaxViews];  ///< of the first hypothesis; null for views without residuals
  int width[kMaxViews];
  float* state;  ///< after those of all views
  std::int64_t stride;
  float factor;

  __device__ __forceinline__ void put(std::int64_t hypothesis, int view, int x, int y,
                                      float residual) const {
    views[view][stride * hypothesis + y * width[view] + x] = factor * residual;
  }
  __device__ __forceinline__ void put_state(std::int64_t hypothesis, int i, float residual) const {
    state[stride * hypothesis + i] = factor * residual;
  }
};

}  // namespace hypotrack::cuda
