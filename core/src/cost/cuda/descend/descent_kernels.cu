#include "cost/cuda/descend/descent_kernels.hpp"

#include <cmath>
#include <limits>

#include "cost/cuda/linearize/gram_matrix.hpp"
#include "cost/cuda/linearize/pixel_rows.hpp"
#include "hypotrack/gpu/pose.cuh"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda::internal {
namespace {

constexpr int kThreads = 128;  // at least one per neighbour
constexpr int kSolveThreads = 512;
constexpr int kSolveWarps = kSolveThreads / kWarp;
static_assert(kMostDescentDimensions < kThreads && kMostTrials < kWarp);

/// The memory of one search.
struct Search {
  const DescentJob& job;
  int index;

  __device__ DescentState& state() const { return job.states[index]; }
  __device__ const double* region(int part) const {
    return job.regions + (4 * index + part) * job.dimension;
  }
  __device__ const double* start() const { return region(0); }
  __device__ const double* lower() const { return region(1); }
  __device__ const double* upper() const { return region(2); }
  __device__ const double* spread() const { return region(3); }
  __device__ double* point(int number) const {
    return job.points + (index * (2 + job.trials) + number) * job.dimension;
  }
  __device__ double* current() const { return point(0); }
  __device__ double* best() const { return point(1); }
  __device__ double* trial(int number) const { return point(2 + number); }
  __device__ double* trial_state(int number) const {
    return job.trial_states + (index * job.trials + number) * job.state_size;
  }
  __device__ double* centre() const { return job.centres + index * job.state_size; }
  /// Returns the state with one dimension moved; 0: the point itself.
  __device__ double* neighbour(int number) const {
    const int before = job.searches + index * (job.dimension + 1) + number;
    return job.centres + before * job.state_size;
  }
};

/// Writes the normalised state of a search point as SearchSpace::states() does. Several threads
/// share the work: `rank` of `size`. `number(d)` is the point's number d.
template <class Number>
__device__ void write_state(const DescentJob& job, const Number& number, double* state, int rank,
                            int size) {
  constexpr double kRoundOff = 8 * std::numeric_limits<double>::epsilon();
  for (int m = 0; m < job.models; ++m) {
    const ModelLayout model = job.model_layouts[m];
    const int first = first_in_point(model, m, job.prior != nullptr);
    const int shift = job.prior ? 1 : 0;
    for (int i = rank; i < model.dimension; i += size) {
      if (i < 3) state[model.offset + i] = number(first + i);
      if (i >= 7) state[model.offset + i] = number(first + i - shift);
      if (i != 3) continue;
      Quaternion<double> q{};
      if (job.prior) {
        const double* p = job.prior + model.offset + 3;
        q = multiply(Quaternion<double>{p[0], p[1], p[2], p[3]},
                     rotation_exp(number(first + 3), number(first + 4), number(first + 5)));
      } else {
        q = {number(first + 3), number(first + 4), number(first + 5), number(first + 6)};
      }
      const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
      if (fabs(square - 1) > kRoundOff) q = unit_quaternion(q.w, q.x, q.y, q.z);
      double* to = state + model.offset + 3;
      to[0] = q.w, to[1] = q.x, to[2] = q.y, to[3] = q.z;
    }
  }
}

/// Writes a state that is not drawn, with the whole block.
__device__ void write_nothing(const DescentJob& job, double* state) {
  for (int i = static_cast<int>(threadIdx.x); i < job.state_size; i += static_cast<int>(blockDim.x))
    state[i] = nan("");
}

__global__ void __launch_bounds__(kThreads)
    begin(const __grid_constant__ DescentJob job, const __grid_constant__ DampedSettings settings) {
  const Search search{job, static_cast<int>(blockIdx.x)};
  const int thread = static_cast<int>(threadIdx.x);
  if (thread < job.dimension) {
    search.current()[thread] = search.best()[thread] = search.trial(0)[thread] =
        search.start()[thread];
  }
  if (thread == 0) {
    search.state() = {DampedSteps(settings), std::numeric_limits<double>::infinity()};
    job.answers[search.index] = {};
    job.rests[search.index] = 1;
  }
  const double* start = search.start();
  write_state(
      job, [&](int d) { return start[d]; }, search.trial_state(0), thread, kThreads);
  for (int i = 1; i < job.trials; ++i) write_nothing(job, search.trial_state(i));
  write_nothing(job, search.centre());
  for (int i = 0; i <= job.dimension; ++i) write_nothing(job, search.neighbour(i));
}

/// The costs of a search's trial points.
struct TakenCosts {
  int count;
  int best = 0;  ///< the first of the lowest
  bool valid = true;
  double lowest = 0;

  /// Adds up and compares the costs, with the whole block.
  __device__ TakenCosts(const Search& search, int count_) : count(count_) {
    __shared__ double costs[kMostTrials];
    const DescentJob& job = search.job;
    const int thread = static_cast<int>(threadIdx.x);
    if (thread < count) {
      const double* own = job.costs + search.index * job.trials + thread;
      double sum = own[0];
      for (int set = 1; set < job.cost_sets; ++set) sum += own[set * (job.searches * job.trials)];
      costs[thread] = sum;
    }
    __syncthreads();
    for (int i = 0; i < count; ++i) {
      valid = valid && costs[i] >= std::numeric_limits<double>::lowest();
      if (costs[i] < costs[best]) best = i;
    }
    lowest = costs[best];
  }
};

/// Returns the largest step to a trial point, in spreads; in every thread of the first warp.
__device__ double longest_step(const Search& search, int trial) {
  double most = 0;
  for (int d = static_cast<int>(threadIdx.x) % kWarp; d < search.job.dimension; d += kWarp) {
    most = fmax(most, fabs((search.trial(trial)[d] - search.current()[d]) / search.spread()[d]));
  }
  for (int step = kWarp / 2; step > 0; step /= 2)
    most = fmax(most, __shfl_xor_sync(kWholeWarp, most, step));
  return most;
}

/// Decides what follows from the costs, with one thread. Returns true if equations do.
__device__ bool decide(DescentState& state, const TakenCosts& costs, double moved) {
  DampedSteps steps = state.steps;
  steps.evaluations += costs.count;
  if (!costs.valid) {
    steps.wants = DampedSteps::Wants::nothing;
  } else if (steps.round < 0) {
    steps.begin(costs.lowest);
  } else if (costs.lowest < steps.cost) {
    steps.accept(costs.best, costs.lowest, moved);
  } else {
    steps.reject();
  }
  const bool linearizes = steps.wants == DampedSteps::Wants::equations;
  if (linearizes) {
    steps.evaluations += steps.settings.price;
    steps.solve();
  }
  if (costs.lowest < state.best_cost) state.best_cost = costs.lowest;
  state.steps = steps;
  return linearizes;
}

/// Writes the states of a point and its neighbours, as difference_steps() places them, with the
/// whole block.
__device__ void place_neighbours(const Search& search, const DampedSteps& steps) {
  __shared__ double moves[kMostDescentDimensions];
  const DescentJob& job = search.job;
  const int thread = static_cast<int>(threadIdx.x), d = job.dimension;
  const double* x = search.current();
  if (thread < d) {
    const double wanted = steps.settings.difference * search.spread()[thread];
    const double up = fmin(search.upper()[thread] - x[thread], wanted);
    const double down = fmin(x[thread] - search.lower()[thread], wanted);
    const double h = up >= down ? up : -down;
    moves[thread] = fabs(h) > 1e-3 * wanted ? h : 0.0;
    job.per_step[search.index * d + thread] =
        moves[thread] != 0 ? static_cast<float>(1 / moves[thread]) : 0.0f;
  }
  if (thread == 0)
    job.blurs[search.index] = static_cast<float>(steps.settings.blur * steps.fineness);
  __syncthreads();
  const auto moved = [&](int i) { return i == thread - 1 ? x[i] + moves[i] : x[i]; };
  if (thread <= d) write_state(job, moved, search.neighbour(thread), 0, 1);
  if (thread == d + 1) write_state(job, moved, search.centre(), 0, 1);
}

/// Writes the answer so far, with the whole block. The host may read it meanwhile: `ended` comes
/// last.
__device__ void write_answer(const Search& search, bool refused) {
  const int thread = static_cast<int>(threadIdx.x);
  const DescentState& state = search.state();
  DescentAnswer& answer = search.job.answers[search.index];
  if (thread < search.job.dimension)
    search.job.answer_points[search.index * search.job.dimension + thread] = search.best()[thread];
  if (thread == 0) {
    answer.cost = state.best_cost;
    answer.evaluations = state.steps.evaluations;
    answer.refused = refused ? 1 : 0;
  }
  __threadfence_system();
  __syncthreads();
  if (thread > 0 || state.steps.wants != DampedSteps::Wants::nothing) return;
  *static_cast<volatile std::int32_t*>(&answer.ended) = 1;
}

__global__ void __launch_bounds__(kThreads) take_costs(const __grid_constant__ DescentJob job) {
  __shared__ bool linearizes;
  const Search search{job, static_cast<int>(blockIdx.x)};
  const int thread = static_cast<int>(threadIdx.x);
  DescentState& state = search.state();
  if (state.steps.wants == DampedSteps::Wants::nothing) return;
  const TakenCosts costs(search, state.steps.points);
  const bool is_best = costs.valid && costs.lowest < state.best_cost;
  const bool moves = state.steps.round >= 0 && costs.lowest < state.steps.cost;
  const double moved = thread < kWarp ? longest_step(search, costs.best) : 0.0;
  __syncthreads();
  if (thread == 0) {
    linearizes = decide(state, costs, moved);
    job.rests[search.index] = linearizes ? 0 : 1;
  }
  if (thread < job.dimension) {
    const double x = search.trial(costs.best)[thread];
    if (is_best) search.best()[thread] = x;
    if (moves) search.current()[thread] = x;
  }
  __syncthreads();
  if (linearizes) {
    place_neighbours(search, state.steps);
  } else {
    write_nothing(job, search.centre());
  }
  write_answer(search, !costs.valid);
}

/// The normal equations of a search in shared memory, per spread, and their solution.
class Equations {
 public:
  static constexpr int kColumns = kMostDescentDimensions + 1;

  /// Reads the equations, with the whole block; ends with a barrier.
  __device__ Equations(const Search& search, double (&a)[kMostDescentDimensions * kColumns])
      : search_(search), a_(a), d_(search.job.dimension) {
    const double* spread = search.spread();
    for (int e = static_cast<int>(threadIdx.x); e < d_ * (d_ + 1); e += kSolveThreads) {
      const int i = e / (d_ + 1), j = e % (d_ + 1);
      const double sum = read(i < j ? i : j, i < j ? j : i);
      at(i, j) = j < d_ ? spread[i] * sum * spread[j] : spread[i] * sum;
    }
    __syncthreads();
  }

  /// Returns number `thread` of the step with a damping, as DampedLeastSquares::step(); called by
  /// the whole block.
  __device__ double step(double damping, double mean_share) {
    __shared__ bool is_free[kMostDescentDimensions];
    __shared__ bool is_finite;
    const int thread = static_cast<int>(threadIdx.x);
    double firm = 0;
    if (mean_share > 0) {
      for (int i = 0; i < d_; ++i) firm += at(i, i);
      firm *= mean_share / d_;
    }
    if (thread < d_) {
      const double x = search_.current()[thread], gradient = at(thread, d_);
      const bool held = (x <= search_.lower()[thread] && gradient > 0) ||
                        (x >= search_.upper()[thread] && gradient < 0);
      is_free[thread] = !held && at(thread, thread) > 0;
    }
    if (thread == 0) is_finite = true;
    __syncthreads();
    for (int e = thread; e < d_ * (d_ + 1); e += kSolveThreads) {
      const int i = e / (d_ + 1), j = e % (d_ + 1);
      if (!is_free[i] || (j < d_ && !is_free[j])) {
        at(i, j) = i == j ? 1.0 : 0.0;
      } else if (i == j) {
        at(i, j) += damping * (at(i, j) + firm);
      } else if (j == d_) {
        at(i, j) = -at(i, j);
      }
    }
    eliminate();
    const double x = thread < d_ ? at(thread, d_) / at(thread, thread) : 0.0;
    if (!(fabs(x) <= std::numeric_limits<double>::max())) is_finite = false;
    __syncthreads();
    return is_finite ? fmin(fmax(x, -1.0), 1.0) : 0.0;
  }

 private:
  __device__ double& at(int i, int j) const { return a_[i * kColumns + j]; }

  /// Reads an entry on or above the diagonal; column D is the gradient.
  __device__ double read(int i, int j) const {
    const DescentJob& job = search_.job;
    double sum = 0;
    if (job.row_sums) {
      const int sides = (d_ + kRowSide) / kRowSide, a = i / kRowSide, b = j / kRowSide;
      const int square = a * sides - a * (a - 1) / 2 + b - a;
      const int all = sides * (sides + 1) / 2;
      sum = job.row_sums[(search_.index * all + square) * kRowSquare + j % kRowSide * kRowSide +
                         i % kRowSide];
    }
    if (!job.gram_sums) return sum;
    const float* per_step = job.per_step + search_.index * d_;
    const double scale = j < d_
                             ? static_cast<double>(per_step[i]) * static_cast<double>(per_step[j])
                             : static_cast<double>(per_step[i]);
    if (scale == 0) return sum;
    const int sides = (d_ + kGramSide) / kGramSide, a = i / kGramSide, b = j / kGramSide;
    const int square = a * sides - a * (a - 1) / 2 + b - a;
    const int all = sides * (sides + 1) / 2;
    return sum + scale * job.gram_sums[(search_.index * all + square) * kGramSquare +
                                       i % kGramSide * kGramSide + j % kGramSide];
  }

  /// Eliminates all entries off the diagonal (Gauss-Jordan). The damped matrix is positive definite
  /// and needs no pivoting. A step reads one row and column and writes only others, so that one
  /// barrier divides it from the next.
  __device__ void eliminate() {
    const int warp = static_cast<int>(threadIdx.x) / kWarp;
    const int lane = static_cast<int>(threadIdx.x) % kWarp;
    for (int p = 0; p < d_; ++p) {
      __syncthreads();
      const double inverse = 1.0 / at(p, p);
      for (int i = warp; i < d_; i += kSolveWarps) {
        if (i == p) continue;
        const double factor = at(i, p) * inverse;
        for (int j = p + 1 + lane; j <= d_; j += kWarp) at(i, j) = fma(-factor, at(p, j), at(i, j));
      }
    }
    __syncthreads();
  }

  const Search& search_;
  double (&a_)[kMostDescentDimensions * kColumns];
  int d_;
};

/// Places trial points: blocks in x are the trials of a search, those in y are searches.
__global__ void __launch_bounds__(kSolveThreads)
    place_trials(const __grid_constant__ DescentJob job) {
  __shared__ double matrix[kMostDescentDimensions * Equations::kColumns];
  const Search search{job, static_cast<int>(blockIdx.y)};
  const int trial = static_cast<int>(blockIdx.x), thread = static_cast<int>(threadIdx.x);
  const DampedSteps& steps = search.state().steps;
  double* state = search.trial_state(trial);
  if (steps.wants != DampedSteps::Wants::costs || trial >= steps.points)
    return write_nothing(job, state);
  Equations equations(search, matrix);
  const double dx = equations.step(steps.damping_of(trial), steps.settings.mean_share);
  double* point = search.trial(trial);
  if (thread < job.dimension) {
    const double x = search.current()[thread] + dx * search.spread()[thread];
    point[thread] = fmin(fmax(x, search.lower()[thread]), search.upper()[thread]);
  }
  __syncthreads();
  write_state(
      job, [&](int d) { return point[d]; }, state, thread, kSolveThreads);
}

}  // namespace

void enqueue_begin(const DescentJob& job, const DampedSettings& settings, Stream stream) {
  launch(&begin, dim3(static_cast<unsigned>(job.searches)), dim3(kThreads), 0, stream, false, job,
         settings);
}

void enqueue_costs_taken(const DescentJob& job, Stream stream) {
  launch(&take_costs, dim3(static_cast<unsigned>(job.searches)), dim3(kThreads), 0, stream, false,
         job);
}

void enqueue_trials(const DescentJob& job, Stream stream) {
  launch(&place_trials,
         dim3(static_cast<unsigned>(job.trials), static_cast<unsigned>(job.searches)),
         dim3(kSolveThreads), 0, stream, false, job);
}

}  // namespace hypotrack::cuda::internal
