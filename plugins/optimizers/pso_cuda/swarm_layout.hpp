#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hypotrack/cuda/device_objective.hpp"
#include "hypotrack/particle.hpp"

namespace hypotrack::cuda {

/// Where a dimension belongs.
struct Membership {
  std::int32_t group;
  std::int32_t limb;  ///< -1: none
};

/// What varies from frame to frame, as 8-byte words: the seed, the number of limbs, then start,
/// lower, upper, spread and membership (D each).
constexpr std::int64_t region_words(std::int64_t dimension) { return 2 + 5 * dimension; }

/// How particles move.
struct Swarming {
  Constriction constriction;
  LimbReset reset;
  double sigma;
};

/// What one generation leaves to the next. Two sets of buffers take turns: blocks of a kernel read
/// all of the one while others already write the other.
struct Generation {
  double* position;       ///< D numbers per particle, one particle after the other
  double* own_best_cost;  ///< per particle, of the generations before this one
  double* best;           ///< position of the best of them all
  double* best_cost;
  bool operator==(const Generation&) const = default;
};

/// A swarm of `particles` in `dimension` numbers each. In device memory but where it says
/// otherwise.
struct SwarmLayout {
  std::int64_t particles;
  std::int64_t dimension;
  const std::uint64_t* frame;  ///< page-locked host memory: the region of the frame to come
  std::uint64_t* region;       ///< its copy
  double* velocity;
  double* own_best;  ///< positions
  double* costs;     ///< of the positions; the evaluation writes them
  double* answer;    ///< page-locked host memory: cost, then position
  std::array<Generation, 2> generations;

  const Generation& generation(std::int64_t number) const {
    return generations[static_cast<std::size_t>(number % 2)];
  }
  bool operator==(const SwarmLayout&) const = default;
};

/// The most blocks that the swarm's kernels are launched with on the current GPU. Throws
/// DeviceError if it cannot run them.
int most_blocks();

/// Enqueues the copying of `frame` to `region`.
void enqueue_region(const SwarmLayout& swarm, Stream stream);
/// Enqueues generation 0: the start and samples about it.
void enqueue_initial(const SwarmLayout& swarm, int most_blocks, const StartSpread& spread,
                     Stream stream);
/// Enqueues the move to generation `generation` >= 1, after the costs of the one before.
void enqueue_move(const SwarmLayout& swarm, int most_blocks, const Swarming& how,
                  std::int64_t generation, Stream stream);
/// Enqueues the answer after the costs of the first `count` particles of generation `last`.
void enqueue_answer(const SwarmLayout& swarm, std::int64_t last, std::int64_t count, Stream stream);

}  // namespace hypotrack::cuda
