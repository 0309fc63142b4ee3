#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "hypotrack/gpu/block_memory.cuh"
#include "hypotrack/gpu/pose.cuh"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {

/// Returns the length of a search point.
__host__ __device__ inline int point_size(const SceneLayout& scene, const BatchLayout& batch) {
  return scene.dimension - (batch.prior ? scene.model_count : 0);
}

/// Decodes one search point with one warp into the scene's normalised state.
__device__ inline void decode_state(const SceneLayout& scene, const BatchLayout& batch,
                                    const double* point, double* state) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const bool rotation_vectors = batch.prior != nullptr;
  for (int m = 0; m < scene.model_count; ++m) {
    const ModelLayout model = scene.models[m];
    const double* p = point + first_in_point(model, m, rotation_vectors);
    double* s = state + model.offset;
    for (int i = lane; i < model.dimension; i += kWarp) {
      if (i < 3) s[i] = __ldcg(p + i);
      if (i >= 7) s[i] = __ldcg(p + i - (rotation_vectors ? 1 : 0));
    }
    if (lane == 0) {
      const Quaternion<double> q = decode_rotation(p, batch.prior, model.offset);
      s[3] = q.w, s[4] = q.x, s[5] = q.y, s[6] = q.z;
    }
  }
  __syncwarp();
}

/// The threads of a warp, for Terms that share their work (OneThread on the CPU).
struct WarpTeam {
  __device__ int rank() const { return static_cast<int>(threadIdx.x) % kWarp; }
  __device__ int size() const { return kWarp; }
  __device__ void sync() const { __syncwarp(); }
  /// Returns the sum over all threads, in each of them; always added in the same order.
  __device__ double sum(double value) const {
    for (int distance = kWarp / 2; distance > 0; distance /= 2) {
      value += __shfl_xor_sync(kWholeWarp, value, distance);
    }
    return value;
  }
};

/// A Term whose cost a team of threads computes together.
template <class Term>
concept TeamTerm = requires(const Term& term) {
  term.scratch_floats();
};

/// Returns the floats of shared memory that a warp needs besides the state.
template <class Term>
__host__ __device__ inline int scratch_floats(const Term& term) {
  if constexpr (TeamTerm<Term>) {
    return term.scratch_floats();
  } else {
    return 0;
  }
}

template <class Term>
__device__ inline double cost_of_state(const Term& term, const double* state, int dimension,
                                       float* scratch) {
  if constexpr (TeamTerm<Term>) {
    return term.cost(state, dimension, WarpTeam{}, scratch);
  } else {
    return threadIdx.x == 0 ? term.cost(state, dimension) : 0.0;
  }
}

/// A Term with residuals.
template <class Term>
concept HasStateTermResiduals = requires(const Term& term) {
  { term.residual_count() } -> std::convertible_to<std::int64_t>;
};

/// A Term for score_states() that also writes residuals.
template <class Term>
struct WithStateResiduals : Term {
  ResidualLayout to;

  __device__ void operator()(std::int64_t i, float residual) const {
    to.residuals[to.stride * blockIdx.x + i] = to.factor * residual;
  }
  __device__ double cost(const double* state, int dimension) const {
    for (std::int64_t i = 0; i < Term::residual_count(); ++i) (*this)(i, Term::residual(i, state));
    return Term::cost(state, dimension);
  }
  template <class Team>
  __device__ double cost(const double* state, int dimension, const Team& team,
                         float* scratch) const {
    return Term::cost_and_residuals(state, dimension, team, scratch, *this);
  }
};

/// Computes the costs of states with one warp per hypothesis.
template <class Term>
__global__ void __launch_bounds__(kWarp)
    score_states(const __grid_constant__ SceneLayout scene,
                 const __grid_constant__ BatchLayout batch, const __grid_constant__ Term term) {
  wait_for_previous();
  let_next_start();
  auto* state = reinterpret_cast<double*>(shared_floats());
  const double* point = batch.points + std::int64_t{blockIdx.x} * point_size(scene, batch);
  decode_state(scene, batch, point, state);
  auto* scratch = reinterpret_cast<float*>(state + scene.dimension);
  const double cost = batch.weight * cost_of_state(term, state, scene.dimension, scratch);
  if (threadIdx.x != 0) return;
  double& out = batch.costs[blockIdx.x];
  out = batch.add ? __ldcg(&out) + cost : cost;
}

/// A device objective that reads only the state (joint limits, priors). Objective::cost can use its
/// Term on the CPU:
///
///   struct MyTerm {  // trivially copyable
///     float stiffness;
///     HYPOTRACK_PIXEL double cost(const double* state, int dimension) const;
///   };
///
/// If one thread is too slow, the Term can share its work among a team of threads. On the CPU, the
/// team is OneThread of skeleton.hpp; pose_bones() there computes the bones of a state.
///
///   HYPOTRACK_PIXEL int scratch_floats() const;  // shared memory of a team
///   template <class Team>
///   HYPOTRACK_PIXEL double cost(const double* state, int dimension, const Team& team,
///                               float* scratch) const;  // aligned to 8 bytes; undefined at first
///
/// If the objective has residuals (ResidualTerm), its Term has
///
///   HYPOTRACK_PIXEL std::int64_t residual_count() const;
///
/// and, without a team,
///
///   HYPOTRACK_PIXEL float residual(std::int64_t i, const double* state) const;
///
/// or, with a team,
///
///   // returns cost() and calls put(i, residual) once per residual, on any thread
///   template <class Team, class Put>
///   HYPOTRACK_PIXEL double cost_and_residuals(const double* state, int dimension,
///                                             const Team& team, float* scratch,
///                                             const Put& put) const;
///
/// `state` is the scene's normalised state. Objective::on_device() returns a
/// StateObjective<MyTerm>. Override make_term() if the Term depends on the frame. As with
/// PixelObjective, a change of the Term's bytes forces captured graphs to be captured again.
template <class Term>
class StateObjective : public DeviceObjective {
 public:
  static_assert(std::is_trivially_copyable_v<Term>, "a Term is copied to the device as it is");

  explicit StateObjective(const Term& term) : term_(term) {}

  void prepare(const DeviceObservation& observation, Stream stream) final {
    const Term term = make_term(observation, stream);
    if (std::memcmp(&term, &term_, sizeof term) != 0) ++revision_;
    std::memcpy(&term_, &term, sizeof term);
  }
  void reserve(const SceneLayout& scene, const DeviceLimits& limits, std::int64_t) final {
    limits_ = limits;
    if (shared_bytes(scene) > most_shared_bytes(limits)) {
      throw DeviceError(
          "CUDA: a term of the state needs more shared memory than the device has; use fewer or "
          "simpler models, or backend: cpu");
    }
    allow_shared_memory(&score_states<Term>, limits);
  }
  void enqueue(const SceneLayout& scene, const BatchLayout& batch, Stream stream) final {
    launch(&score_states<Term>, dim3(static_cast<unsigned>(batch.count)), dim3(kWarp),
           shared_bytes(scene), stream, overlaps_launches(limits_), scene, batch, term_);
  }

  bool has_residuals() const final { return HasStateTermResiduals<Term>; }
  std::int64_t residual_count() const final {
    if constexpr (HasStateTermResiduals<Term>) {
      return term_.residual_count();
    } else {
      return 0;
    }
  }

  void enqueue_drawn(const SceneLayout& scene, const BatchLayout& batch, const DrawnBatch& drawn,
                     Stream stream) final {
    enqueue(scene, part_of(scene, batch, drawn), stream);
  }
  void enqueue_residuals(const SceneLayout& scene, const BatchLayout& batch,
                         const DrawnBatch& drawn, const ResidualLayout& residuals,
                         Stream stream) final {
    if constexpr (HasStateTermResiduals<Term>) {
      const BatchLayout part = part_of(scene, batch, drawn);
      ResidualLayout to = residuals;
      to.residuals += drawn.first * residuals.stride;
      const WithStateResiduals<Term> term{term_, to};
      const auto kernel = &score_states<WithStateResiduals<Term>>;
      allow_shared_memory(kernel, limits_);
      launch(kernel, dim3(static_cast<unsigned>(part.count)), dim3(kWarp), shared_bytes(scene),
             stream, overlaps_launches(limits_), scene, part, term);
    } else {
      DeviceObjective::enqueue_residuals(scene, batch, drawn, residuals, stream);
    }
  }
  std::uint64_t revision() const final { return revision_; }

 protected:
  /// Returns the Term for a frame; may enqueue kernels that fill its device memory. Throws
  /// DataError if the observation does not suit.
  virtual Term make_term(const DeviceObservation& /*observation*/, Stream /*stream*/) {
    return term_;
  }

 private:
  static BatchLayout part_of(const SceneLayout& scene, const BatchLayout& batch,
                             const DrawnBatch& drawn) {
    BatchLayout part = batch;
    part.points += drawn.first * point_size(scene, batch);
    part.costs += drawn.first;
    part.count = drawn.count;
    return part;
  }

  std::size_t shared_bytes(const SceneLayout& scene) const {
    return sizeof(double) * static_cast<std::size_t>(scene.dimension) +
           sizeof(float) * static_cast<std::size_t>(scratch_floats(term_));
  }

  Term term_;
  DeviceLimits limits_;
  std::uint64_t revision_ = 0;
};

}  // namespace hypotrack::cuda
