#pragma once

#include <cstdint>

#include "hypotrack/gpu/runtime.cuh"
#include "hypotrack/gpu/swarm_search.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "swarm_layout.hpp"

namespace hypotrack::cuda {

/// Memory of a swarm, on the device and page-locked on the host; never shrinks.
class SwarmMemory {
 public:
  /// Reserves memory and returns its layout. Throws DeviceError if there is not enough.
  SwarmLayout reserve(std::int64_t particles, std::int64_t dimension);
  /// Prepares a search by a single kernel of `generations`, all but the parameters of motion.
  /// Throws DeviceError if there is not enough memory.
  SwarmSearch search(const SwarmLayout& swarm, std::int64_t generations, const SearchRegion& region,
                     std::uint64_t seed);
  /// Writes the input of the next kernels of the swarm; none of them may be running.
  void write(const SearchRegion& region, std::uint64_t seed);
  /// Returns the cost and position that the kernels of a swarm in `dimension` dimensions wrote
  /// last.
  OptimizerResult answer(std::int64_t dimension) const;

 private:
  DeviceBuffer<double> memory_;
  DeviceBuffer<double> slots_;
  DeviceBuffer<std::uint64_t> region_;
  PinnedBuffer<std::uint64_t> frame_;
  PinnedBuffer<double> answer_;
};

}  // namespace hypotrack::cuda
