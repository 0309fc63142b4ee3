#pragma once

#include <array>
#include <limits>

#include "hypotrack/gpu/best_cost.cuh"
#include "hypotrack/gpu/evaluate.cuh"
#include "hypotrack/gpu/swarm_search.hpp"

/// A particle swarm search in one kernel. The blocks of a particle evaluate it, read the other
/// particles' costs from slots, and move it. The arithmetic equals that of the kernels of
/// plugins/optimizers/pso_cuda, which serve all other objectives. Nothing is staged again, and no
/// kernel waits for another.
namespace hypotrack::cuda {

/// The random numbers of one dimension's move.
struct SwarmDraw {
  std::array<double, 4> uniform;
  bool anew = false;  ///< true if the dimension is resampled instead of moved
  double offset = 0;  ///< from the swarm's best, if resampled

  __device__ SwarmDraw(const SwarmSearch& swarm, int d, const RandomIndex& index) {
    uniform = uniform4(swarm.seed, index);
    if (swarm.limbs == 0 || !swarm.reset.due(index.generation)) return;
    const int limb = swarm.reset.limb(swarm.seed, index.particle, index.generation, swarm.limbs);
    anew = limb >= 0 && swarm.dimensions[d].limb == limb;
    if (anew) {
      offset = anew_offset(swarm.start.sigma * swarm.dimensions[d].spread, swarm.seed, index);
    }
  }
};

/// A particle in one of its blocks. The block's last threads, in whole warps (movers()), handle one
/// dimension each and keep it in shared memory. Generations count from 0.
class SwarmParticle {
 public:
  __device__ SwarmParticle(const SwarmSearch& swarm, const BlockPlan& plan)
      : swarm_(swarm), plan_(plan) {}

  /// Returns the number of threads that call the functions below.
  __device__ static int movers(const SwarmSearch& swarm) {
    return (swarm.dimension + kWarp - 1) / kWarp * kWarp;
  }

  /// Places the particle in generation 0. A barrier must follow.
  __device__ void begin() const {
    if (dimension() >= swarm_.dimension) return;
    const SwarmDimension& d = swarm_.dimensions[dimension()];
    double x = d.start;
    if (number() > 0) {
      const auto own = static_cast<std::uint32_t>(number());
      const double deviation =
          d.spread * swarm_.start.of_group(swarm_.seed, static_cast<std::uint32_t>(d.group), own);
      x = start_sample(x, deviation, {d.lower, d.upper}, swarm_.seed,
                       static_cast<std::uint32_t>(dimension()), own);
    }
    mine(kPosition) = mine(kOwnBest) = x;
    mine(kVelocity) = 0;
    mine(kBest) = d.start;
    mine(kLower) = d.lower;
    mine(kUpper) = d.upper;
    mine(kOwnBestCost) = mine(kBestCost) = std::numeric_limits<double>::infinity();
    place(0, x);
  }

  /// Moves the particle to a generation >= 1, once all costs of the previous one are known. A
  /// barrier must follow.
  __device__ void move_to(std::int32_t generation) const {
    const int d = min(dimension(), swarm_.dimension - 1);  // keeps the threads of a warp together
    const SwarmDraw draw(swarm_, d,
                         {static_cast<std::uint32_t>(d), static_cast<std::uint32_t>(number()),
                          static_cast<std::uint32_t>(generation), kMoveStream});
    const double best = learn(generation - 1);
    if (dimension() >= swarm_.dimension) return;
    const Interval bounds{mine(kLower), mine(kUpper)};
    const Motion motion =
        draw.anew ? placed_anew(best, draw.offset, bounds)
                  : moved({mine(kPosition), mine(kVelocity)}, swarm_.constriction, mine(kOwnBest),
                          best, draw.uniform[0], draw.uniform[1], bounds);
    place(generation, motion.position);
    mine(kPosition) = motion.position;
    mine(kVelocity) = motion.velocity;
  }

  /// Writes the best point of all generations up to `last`. A barrier and clear() must follow.
  __device__ void answer(std::int32_t last) const {
    learn(last);
    const int d = dimension();
    if (d < swarm_.dimension) swarm_.answer[1 + d] = mine(kBest);
    if (d == 0) swarm_.answer[0] = mine(kBestCost);
  }
  /// Empties all slots.
  __device__ void clear(std::int32_t last) const {
    for (std::int32_t generation = max(last - 1, 0); generation <= last; ++generation) {
      for (int p = dimension(); p < swarm_.particles; p += movers(swarm_)) {
        clear_slot(slot(generation, p));
      }
    }
  }

  /// Makes the position visible before publish() publishes its cost. The thread that will call
  /// publish() calls it well before, after a barrier behind the movers, because a fence takes time.
  __device__ void before_publishing() const { __threadfence(); }
  __device__ void publish(std::int32_t generation, double cost) const {
    fill_slot(slot(generation, number()), cost);
  }

 private:
  enum Number {
    kPosition,
    kVelocity,
    kOwnBest,
    kOwnBestCost,
    kBest,  ///< of the swarm
    kBestCost,
    kLower,
    kUpper
  };
  static_assert(kUpper + 1 == kParticleNumbers);

  // Recomputed at every use, because registers are scarce.
  __device__ std::int32_t number() const {
    return static_cast<std::int32_t>(blockIdx.x / static_cast<unsigned>(plan_.bands));
  }
  /// Returns true in the block that publishes the particle's cost.
  __device__ bool publishes() const { return blockIdx.x % static_cast<unsigned>(plan_.bands) == 0; }
  /// Returns this thread's dimension; may lie beyond the last.
  __device__ int dimension() const {
    return static_cast<int>(threadIdx.x) - (static_cast<int>(blockDim.x) - movers(swarm_));
  }
  __device__ double& mine(Number number) const {
    auto* numbers = reinterpret_cast<double*>(shared_floats() + plan_.particle);
    return numbers[number * swarm_.dimension + dimension()];
  }
  /// Returns one of two alternating buffers. The previous generation is read until the next one's
  /// costs are known.
  __device__ double* positions(std::int32_t generation) const {
    return swarm_.positions + generation % 2 * (swarm_.particles * swarm_.dimension);
  }
  __device__ double* slot(std::int32_t generation, int particle) const {
    return swarm_.costs + kSlotStride * (generation % 3 * swarm_.particles + particle);
  }

  __device__ void place(std::int32_t generation, double x) const {
    put_in_point(dimension(), x, plan_.pose);
    if (publishes()) {
      __stcg(positions(generation) + (number() * swarm_.dimension + dimension()), x);
    }
  }

  /// Waits for all costs of a generation and updates the own and the swarm's best. Returns this
  /// thread's coordinate of the swarm's best point.
  __device__ double learn(std::int32_t generation) const {
    const int lane = static_cast<int>(threadIdx.x) % kWarp;
    // A thread uses only its own numbers; threads without a dimension have none.
    const bool has_dimension = dimension() < swarm_.dimension;
    // The first thread of a warp always has a dimension.
    const double known = __shfl_sync(kWholeWarp, has_dimension ? mine(kBestCost) : 0, 0);
    double best = has_dimension ? mine(kBest) : 0, own = 0;
    Candidate of_lane, found;
    int next = lane;  // particle that this lane reads next
    bool is_last = false;
#pragma unroll 1
    while (!is_last) {
      const std::uint64_t bits =
          next < swarm_.particles ? look_into_slot(slot(generation, next)) : kEmptySlot;
      if (bits != kEmptySlot) {
        const double cost = __longlong_as_double(static_cast<long long>(bits));
        if (cost < known) of_lane = better(of_lane, {cost, next});
        if (next == number()) own = cost;
        next += kWarp;
      }
      is_last = !__any_sync(kWholeWarp, next < swarm_.particles);
      const Candidate now = best_of_few(of_lane);
      // Fetch its position while waiting for others. The read goes to the L2 cache, at an address
      // that depends on the slot, and so comes after it. (PTX's memory model guarantees this only
      // behind a fence.)
      if (now.particle != found.particle && has_dimension) {
        best = __ldcg(positions(generation) + (now.particle * swarm_.dimension + dimension()));
      }
      found = now;
    }
    own = __shfl_sync(kWholeWarp, own, number() % kWarp);
    if (!has_dimension) return best;
    if (own < mine(kOwnBestCost)) {
      mine(kOwnBest) = mine(kPosition);
      mine(kOwnBestCost) = own;
    }
    if (found.cost < known) {
      mine(kBest) = best;
      mine(kBestCost) = found.cost;
    }
    // All blocks have read the previous generation's costs; otherwise this one's would not exist.
    if (publishes() && dimension() == 0 && generation > 0) {
      clear_slot(slot(generation - 1, number()));
    }
    return best;
  }

  /// Returns the best candidate of a warp, in all lanes; fast if few lanes have one.
  __device__ static Candidate best_of_few(const Candidate& mine) {
    const unsigned lanes = __ballot_sync(kWholeWarp, mine.cost < Candidate().cost);
    if (lanes == 0) return {};
    if ((lanes & (lanes - 1)) != 0) return best_of_warp(mine);
    const int lane = __ffs(static_cast<int>(lanes)) - 1;
    return {__shfl_sync(kWholeWarp, mine.cost, lane), __shfl_sync(kWholeWarp, mine.particle, lane)};
  }

  const SwarmSearch& swarm_;
  const BlockPlan& plan_;
};

/// Publishes the cost of its block's particle.
struct CostPublisher {
  const SwarmParticle& particle;
  std::int32_t generation;
  __device__ void prepare() const { particle.before_publishing(); }
  __device__ void put(double cost) const { particle.publish(generation, cost); }
};

/// Runs a whole search. All blocks must be on the device at once (launch_together()).
template <class Term, Walk kWalk>
__global__ void __launch_bounds__(kMostThreads)
    search_with_swarm(const __grid_constant__ SceneLayout scene, const FrameLayout* frame,
                      const __grid_constant__ BatchLayout batch,
                      const __grid_constant__ BlockPlan plan, const __grid_constant__ Term term,
                      const __grid_constant__ SwarmSearch swarm) {
  __shared__ BlockState state;
  BlockEvaluation<Term, kWalk, true> block(scene, batch, plan, term, state);
  block.begin(frame);
  const SwarmParticle particle(swarm, plan);
  const int others = static_cast<int>(blockDim.x) - SwarmParticle::movers(swarm);
  const bool moves = static_cast<int>(threadIdx.x) >= others;
  if (moves) particle.begin();
#pragma unroll 1
  for (std::int32_t generation = 0;;) {
    __syncthreads();
    block.run(static_cast<unsigned>(generation), CostPublisher{particle, generation});
    if (++generation == swarm.generations) break;
    block.begin_again(others);
    if (moves) particle.move_to(generation);
  }
  if (blockIdx.x > 0) return;
  const std::int32_t last = swarm.generations - 1;
  if (moves) particle.answer(last);
  __syncthreads();
  if (moves) particle.clear(last);
}

}  // namespace hypotrack::cuda
