#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/particle.hpp"

namespace hypotrack::cuda {

/// Group and limb of a dimension.
struct Membership {
  std::int32_t group;
  std::int32_t limb;  ///< -1: none
};

/// Returns the number of 8-byte words of a frame's region: the seed, the number of limbs, then
/// start, lower, upper, spread and membership (D each).
constexpr std::int64_t region_words(std::int64_t dimension) { return 2 + 5 * dimension; }

/// Parameters of the particles' motion.
struct SwarmSettings {
  Constriction constriction;
  LimbReset reset;
  double sigma;
};

/// State that one generation passes to the next. Two sets of buffers alternate: some blocks of a
/// kernel still read one while others already write the other.
struct Generation {
  double* position;       ///< D numbers per particle, particle by particle
  double* own_best_cost;  ///< per particle, over the generations before this one
  double* best;           ///< position of the lowest cost
  double* best_cost;
  bool operator==(const Generation&) const = default;
};

/// Memory of a swarm of `particles` in `dimension` dimensions each: device memory unless stated
/// otherwise.
struct SwarmLayout {
  std::int64_t particles;
  std::int64_t dimension;
  const std::uint64_t* frame;  ///< page-locked host memory: the region of the next frame
  std::uint64_t* region;       ///< copy of `frame`
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

/// Returns the largest number of blocks for the swarm's kernels on the current GPU. Throws
/// DeviceError if it cannot run them.
int most_blocks();

/// Enqueues the copy of `frame` to `region`.
void enqueue_region(const SwarmLayout& swarm, Stream stream);
/// Enqueues generation 0: the start and samples around it.
void enqueue_initial(const SwarmLayout& swarm, int most_blocks, const StartDistribution& starts,
                     Stream stream);
/// Enqueues the move to generation `generation` >= 1, after the costs of the one before.
void enqueue_move(const SwarmLayout& swarm, int most_blocks, const SwarmSettings& how,
                  std::int64_t generation, Stream stream);
/// Enqueues writing the answer, after the costs of the first `count` particles of generation
/// `last`.
void enqueue_answer(const SwarmLayout& swarm, std::int64_t last, std::int64_t count, Stream stream);

}  // namespace hypotrack::cuda
