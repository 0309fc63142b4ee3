#pragma once

#include <cstdint>

#include "base/exported.hpp"
#include "hypotrack/gpu/damped_steps.hpp"
#include "hypotrack/gpu/device_objective.hpp"

/// Searches by damped least squares in GPU memory. The kernels take costs and normal equations and
/// place the states that are evaluated and linearised next.
namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

inline constexpr int kMostDescentDimensions = 64;
inline constexpr int kMostTrials = 16;

/// A search in device memory.
struct DescentState {
  DampedSteps steps;
  double best_cost;  ///< of all points so far
};

/// An answer in page-locked memory, complete once `ended` is set.
struct DescentAnswer {
  double cost;
  std::int64_t evaluations;
  std::int32_t ended;
  std::int32_t refused;  ///< a cost was NaN or -infinity
};

/// Memory of K searches in D dimensions with T trial steps, for a scene's state of S numbers. All
/// is in device memory except the answers.
struct DescentJob {
  std::int32_t searches, dimension, trials;  ///< K, D, T
  std::int32_t state_size;                   ///< S
  std::int32_t models;
  const ModelLayout* model_layouts;
  const double* prior;    ///< S: what rotation vectors apply to; null: points are states
  const double* regions;  ///< K x (start, lower, upper, spread)
  DescentState* states;   ///< K
  double* points;         ///< K x (current, best, T trial points)
  double* trial_states;   ///< K x T states, NaN where none is evaluated
  const double* costs;    ///< cost_sets x K x T, which add up
  std::int32_t cost_sets;
  double* centres;          ///< K states, NaN where none is linearised; then K x (D + 1) neighbours
  float* per_step;          ///< K x D: 1 / the neighbours' steps, 0 for none
  float* blurs;             ///< K: pixels
  std::int32_t* rests;      ///< K: 1 where the equations stay as they are
  const double* row_sums;   ///< K x row_numbers(D), or null
  const double* gram_sums;  ///< K x gram_numbers(D), or null
  DescentAnswer* answers;   ///< K
  double* answer_points;    ///< K x D
};

/// Enqueues the beginning of all searches: their starts become the first trial states.
void enqueue_begin(const DescentJob& job, const DampedSettings& settings, Stream stream);
/// Enqueues the decision on the costs of the trial states, and the centres' states.
void enqueue_costs_taken(const DescentJob& job, Stream stream);
/// Enqueues the solution of the normal equations, and the next trial states.
void enqueue_trials(const DescentJob& job, Stream stream);

}  // namespace internal
}  // namespace hypotrack::cuda
