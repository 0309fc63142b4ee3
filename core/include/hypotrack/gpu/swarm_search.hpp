#pragma once

#include <cstdint>

#include "hypotrack/plugin/particle.hpp"

namespace hypotrack::cuda {

/// Most dimensions of a SwarmSearch, which is passed to the kernel by value.
inline constexpr int kMostSwarmDimensions = 64;

/// Distance between slots of SwarmSearch::costs, doubles. Each slot has its own L2 sector, because
/// all blocks read all slots at the same time.
inline constexpr int kSlotStride = 4;

/// Start, bounds, spread and groups of one dimension.
struct SwarmDimension {
  double start, lower, upper, spread;
  std::int32_t group;
  std::int32_t limb;  ///< index of its limb; -1 = none
};

/// A whole particle swarm search (plugins/optimizers/pso) for one kernel that evaluates and moves
/// all particles.
struct SwarmSearch {
  std::int32_t particles;
  std::int32_t generations;
  std::int32_t dimension;  ///< of a search point, at most kMostSwarmDimensions
  std::int32_t limbs;
  std::uint64_t seed;
  Constriction constriction;
  LimbReset reset;
  StartDistribution start;
  SwarmDimension dimensions[kMostSwarmDimensions];
  double* positions;  ///< device memory for 2 generations
  double* costs;      ///< device memory, 3 slots per particle (bands.cuh), kSlotStride apart; empty
                      ///< before and after
  double* answer;     ///< page-locked host memory: cost, then position
};

}  // namespace hypotrack::cuda
