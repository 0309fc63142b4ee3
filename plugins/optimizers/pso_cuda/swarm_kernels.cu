#include <algorithm>
#include <limits>

#include "hypotrack/gpu/best_cost.cuh"
#include "hypotrack/gpu/runtime.cuh"
#include "hypotrack/plugin/particle.hpp"
#include "swarm_layout.hpp"

namespace hypotrack::cuda {
namespace {

constexpr int kThreads = 256;
constexpr int kAnswerThreads = 1024;
constexpr int kBlocksPerMultiprocessor = 4;  // each reads all costs: more would only read more

/// The frame's region in device memory.
struct Region {
  std::uint64_t seed;
  std::int32_t limbs;
  const double* start;
  const double* lower;
  const double* upper;
  const double* spread;
  const std::uint64_t* membership;

  __device__ explicit Region(const SwarmLayout& swarm)
      : seed(__ldcg(swarm.region)),
        limbs(static_cast<std::int32_t>(__ldcg(swarm.region + 1))),
        start(reinterpret_cast<const double*>(swarm.region + 2)),
        lower(start + swarm.dimension),
        upper(lower + swarm.dimension),
        spread(upper + swarm.dimension),
        membership(reinterpret_cast<const std::uint64_t*>(spread + swarm.dimension)) {}

  __device__ Interval bounds(std::int64_t d) const {
    return {__ldcg(lower + d), __ldcg(upper + d)};
  }
  __device__ Membership membership_of(std::int64_t d) const {
    const std::uint64_t word = __ldcg(membership + d);
    return {static_cast<std::int32_t>(word), static_cast<std::int32_t>(word >> 32)};
  }
};

/// One dimension of one particle.
struct Element {
  std::int64_t index;  ///< in the swarm's arrays
  std::int64_t particle;
  std::int64_t dimension;

  __device__ Element(const SwarmLayout& swarm, std::int64_t i)
      : index(i), particle(i / swarm.dimension), dimension(i - particle * swarm.dimension) {}
};

__device__ std::int64_t first_element() {
  return std::int64_t{blockIdx.x} * kThreads + threadIdx.x;
}
__device__ std::int64_t next_element(std::int64_t i) {
  return i + std::int64_t{gridDim.x} * kThreads;
}

/// The random numbers of an element's move.
struct Draw {
  std::array<double, 4> uniform;
  bool anew = false;  ///< the element is placed anew instead of moved
  double offset = 0;  ///< from the swarm's best, if placed anew

  __device__ Draw(const Region& region, const Element& at, const SwarmSettings& how,
                  std::uint32_t generation) {
    const RandomIndex index{static_cast<std::uint32_t>(at.dimension),
                            static_cast<std::uint32_t>(at.particle), generation, kMoveStream};
    uniform = uniform4(region.seed, index);
    if (region.limbs == 0 || !how.reset.due(generation)) return;
    const int limb = how.reset.limb(region.seed, index.particle, generation, region.limbs);
    anew = limb >= 0 && region.membership_of(at.dimension).limb == limb;
    if (!anew) return;
    offset = anew_offset(how.sigma * __ldcg(region.spread + at.dimension), region.seed, index);
  }
};

__global__ void __launch_bounds__(kThreads) copy_region(const SwarmLayout swarm) {
  let_next_start();
  for (std::int64_t i = threadIdx.x; i < region_words(swarm.dimension); i += kThreads) {
    swarm.region[i] = swarm.frame[i];
  }
}

// Lets the next kernel start only after the wait. So every later kernel finds the region, even
// before its own wait.
__global__ void __launch_bounds__(kThreads)
    initial(const SwarmLayout swarm, const Generation now, const StartDistribution starts) {
  wait_for_previous();
  let_next_start();
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Region region(swarm);
  const std::int64_t elements = swarm.particles * swarm.dimension;
  for (std::int64_t i = first_element(); i < elements; i = next_element(i)) {
    const Element at(swarm, i);
    const std::int64_t d = at.dimension;
    double x = region.start[d];
    if (at.particle > 0) {
      const auto number = static_cast<std::uint32_t>(at.particle);
      const auto group = static_cast<std::uint32_t>(region.membership_of(d).group);
      x = start_sample(x, region.spread[d] * starts.of_group(region.seed, group, number),
                       region.bounds(d), region.seed, static_cast<std::uint32_t>(d), number);
    } else {
      now.best[d] = x;
    }
    now.position[i] = x;
    swarm.own_best[i] = x;
    swarm.velocity[i] = 0.0;
    if (d == 0) now.own_best_cost[at.particle] = kNone;
    if (i == 0) *now.best_cost = kNone;
  }
}

/// An element of a particle with its present and best position.
struct Mover {
  Element at;
  double x, v, own_best, own_best_cost;

  __device__ Mover(const SwarmLayout& swarm, const Generation& before, const Element& element)
      : at(element),
        x(__ldcg(before.position + at.index)),
        v(__ldcg(swarm.velocity + at.index)),
        own_best(__ldcg(swarm.own_best + at.index)),
        own_best_cost(__ldcg(before.own_best_cost + at.particle)) {}

  /// Updates the element's best position with the cost of the present one.
  __device__ void remember(const SwarmLayout& swarm, const Generation& now, double cost) {
    const bool improved = cost < own_best_cost;
    if (improved) swarm.own_best[at.index] = own_best = x;
    if (at.dimension == 0) now.own_best_cost[at.particle] = improved ? cost : own_best_cost;
  }

  __device__ void move(const SwarmLayout& swarm, const Generation& now,
                       const Constriction& constriction, double swarm_best, const Draw& draw,
                       const Interval& bounds) const {
    const Motion motion = draw.anew ? placed_anew(swarm_best, draw.offset, bounds)
                                    : moved({x, v}, constriction, own_best, swarm_best,
                                            draw.uniform[0], draw.uniform[1], bounds);
    now.position[at.index] = motion.position;
    swarm.velocity[at.index] = motion.velocity;
  }
};

/// The best point of all generations, `before` included.
struct Best {
  const double* point;
  double cost;

  /// Finds the best point; all threads of a block of kBlock must call it. `known` is the best cost
  /// of the generations before the last. `position` has the positions of the last generation.
  template <int kBlock>
  static __device__ Best find(const SwarmLayout& swarm, const Generation& before, double known,
                              std::int32_t count, const double* position) {
    const Candidate found = best_of_costs<kBlock>(swarm.costs, count);
    if (!(found.cost < known)) return {before.best, known};
    return {position + found.particle * swarm.dimension, found.cost};
  }
};

/// Positions that fit into a block's shared memory, so that the best is at hand once it is known.
constexpr int kKept = 2048;

// Reads the results of the last move before the wait. This is safe: the evaluation in between lets
// this kernel start only after its own wait for that move (let_next_start()). The results are in
// the L2 cache; a multiprocessor's L1 cache may hold older data. Only the costs need the wait.
__global__ void __launch_bounds__(kThreads)
    move(const SwarmLayout swarm, const Generation before, const Generation now,
         const SwarmSettings how, const std::uint32_t generation) {
  __shared__ double kept[kKept];
  let_next_start();
  const std::int64_t elements = swarm.particles * swarm.dimension;
  const Region region(swarm);
  // All threads search for the best, also those without an element.
  std::int64_t i = first_element();
  const Element first(swarm, i < elements ? i : 0);
  const Interval first_bounds = region.bounds(first.dimension);
  Mover mover(swarm, before, first);
  const double best_before = __ldcg(before.best_cost);
  const bool keep = elements <= kKept;
  if (keep) {
    for (auto k = static_cast<std::int64_t>(threadIdx.x); k < elements; k += kThreads) {
      kept[k] = __ldcg(before.position + k);
    }
  }
  const Draw first_draw(region, first, how, generation);
  __syncthreads();
  wait_for_previous();

  const double cost = __ldcg(swarm.costs + first.particle);
  const Best best =
      Best::find<kThreads>(swarm, before, best_before, static_cast<std::int32_t>(swarm.particles),
                           keep ? kept : before.position);
  if (i < elements) {
    mover.remember(swarm, now, cost);
    mover.move(swarm, now, how.constriction, best.point[first.dimension], first_draw, first_bounds);
  }
  while ((i = next_element(i)) < elements) {
    const Element at(swarm, i);
    Mover other(swarm, before, at);
    other.remember(swarm, now, __ldcg(swarm.costs + at.particle));
    other.move(swarm, now, how.constriction, best.point[at.dimension],
               Draw(region, at, how, generation), region.bounds(at.dimension));
  }
  if (blockIdx.x > 0) return;
  for (std::int64_t d = threadIdx.x; d < swarm.dimension; d += kThreads) {
    now.best[d] = best.point[d];
  }
  if (threadIdx.x == 0) *now.best_cost = best.cost;
}

__global__ void __launch_bounds__(kAnswerThreads)
    write_answer(const SwarmLayout swarm, const Generation last, const std::int32_t count) {
  wait_for_previous();
  const Best best =
      Best::find<kAnswerThreads>(swarm, last, __ldcg(last.best_cost), count, last.position);
  for (std::int64_t d = threadIdx.x; d < swarm.dimension; d += kAnswerThreads) {
    swarm.answer[1 + d] = best.point[d];
  }
  if (threadIdx.x == 0) swarm.answer[0] = best.cost;
}

dim3 blocks(const SwarmLayout& swarm, int most) {
  const std::int64_t wanted = (swarm.particles * swarm.dimension + kThreads - 1) / kThreads;
  return static_cast<unsigned>(std::min<std::int64_t>(wanted, most));
}

}  // namespace

int most_blocks() {
  int device = 0, multiprocessors = 0;
  check(cudaGetDevice(&device), "asking for the current device");
  check(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device),
        "asking for the number of multiprocessors");
  cudaFuncAttributes attributes{};
  check(cudaFuncGetAttributes(&attributes, move), "loading the kernels of pso_cuda");
  // Use the evaluation's split between shared memory and cache, which prefers the most shared
  // memory. A multiprocessor must be idle to change it, so neither kernel could start early.
  for (const void* kernel :
       {reinterpret_cast<const void*>(copy_region), reinterpret_cast<const void*>(initial),
        reinterpret_cast<const void*>(move), reinterpret_cast<const void*>(write_answer)}) {
    check(cudaFuncSetAttribute(kernel, cudaFuncAttributePreferredSharedMemoryCarveout,
                               cudaSharedmemCarveoutMaxShared),
          "choosing the shared memory of pso_cuda");
  }
  return kBlocksPerMultiprocessor * multiprocessors;
}

void enqueue_region(const SwarmLayout& swarm, Stream stream) {
  // Waits for all work enqueued before the search, so that later kernels need not.
  launch(copy_region, 1, kThreads, 0, stream, false, swarm);
}

void enqueue_initial(const SwarmLayout& swarm, int most_blocks, const StartDistribution& starts,
                     Stream stream) {
  launch(initial, blocks(swarm, most_blocks), kThreads, 0, stream, true, swarm, swarm.generation(0),
         starts);
}

void enqueue_move(const SwarmLayout& swarm, int most_blocks, const SwarmSettings& how,
                  std::int64_t generation, Stream stream) {
  launch(move, blocks(swarm, most_blocks), kThreads, 0, stream, true, swarm,
         swarm.generation(generation - 1), swarm.generation(generation), how,
         static_cast<std::uint32_t>(generation));
}

void enqueue_answer(const SwarmLayout& swarm, std::int64_t last, std::int64_t count,
                    Stream stream) {
  launch(write_answer, 1, kAnswerThreads, 0, stream, true, swarm, swarm.generation(last),
         static_cast<std::int32_t>(count));
}

}  // namespace hypotrack::cuda
