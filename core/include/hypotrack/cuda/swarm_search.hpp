#pragma once

#include <cstdint>

#include "hypotrack/particle.hpp"

namespace hypotrack::cuda {

/// Most dimensions of a SwarmSearch: it is handed to the kernel by value.
inline constexpr int kMostSwarmDimensions = 64;

/// From slot to slot of SwarmSearch::costs: a sector of the L2 cache each, for all blocks look at
/// all of them at the same time.
inline constexpr int kSlotStride = 4;

/// Where a dimension of a search begins and how far it may go.
struct SwarmDimension {
  double start, lower, upper, spread;
  std::int32_t group;
  std::int32_t limb;  ///< -1: none
};

/// A whole search by a particle swarm (plugins/optimizers/pso), for a kernel that evaluates and
/// moves its particles without leaving the device in between.
struct SwarmSearch {
  std::int32_t particles;
  std::int32_t generations;
  std::int32_t dimension;  ///< of a search point, at most kMostSwarmDimensions
  std::int32_t limbs;
  std::uint64_t seed;
  Constriction constriction;
  LimbReset reset;
  StartSpread start;
  SwarmDimension dimensions[kMostSwarmDimensions];
  double* positions;  ///< device memory: room for 2 generations
  double* costs;      ///< device memory: 3 slots per particle (bands.cuh), kSlotStride apart, empty
                      ///< before and after
  double* answer;     ///< page-locked host memory: cost, then position
};

}  // namespace hypotrack::cuda
