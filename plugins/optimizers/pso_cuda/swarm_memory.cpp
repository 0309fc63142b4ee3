#include "swarm_memory.hpp"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "hypotrack/plugin/start_points.hpp"
#include "swarm.hpp"

namespace hypotrack::cuda {

SwarmLayout SwarmMemory::reserve(std::int64_t particles, std::int64_t dimension) {
  const std::int64_t elements = particles * dimension;
  const auto size = [](std::int64_t count) { return static_cast<std::size_t>(count); };
  memory_.reserve(size(4 * elements + 3 * particles + 2 * dimension + 2));
  region_.reserve(size(region_words(dimension)));
  frame_.reserve(size(region_words(dimension)));
  answer_.reserve(size(1 + dimension));

  double* next = memory_.data();
  const auto take = [&](std::int64_t count) { return std::exchange(next, next + count); };
  SwarmLayout swarm{};
  swarm.particles = particles;
  swarm.dimension = dimension;
  swarm.frame = frame_.data();
  swarm.region = region_.data();
  swarm.velocity = take(elements);
  swarm.own_best = take(elements);
  swarm.costs = take(particles);
  for (Generation& generation : swarm.generations) {
    generation = {take(elements), take(particles), take(dimension), take(1)};
  }
  swarm.answer = answer_.data();
  return swarm;
}

SwarmSearch SwarmMemory::search(const SwarmLayout& swarm, std::int64_t generations,
                                const SearchRegion& region, std::uint64_t seed) {
  // Free slots have all bits set, before and after every search (bands.cuh).
  if (slots_.reserve(static_cast<std::size_t>(3 * kSlotStride * swarm.particles))) {
    check(cudaMemset(slots_.data(), 0xFF, slots_.size() * sizeof(double)), "emptying memory");
    check(cudaStreamSynchronize(nullptr), "emptying memory");
  }
  const Limbs limbs(region);
  const std::vector<int> groups = groups_or_dimensions(region);
  SwarmSearch search{};
  search.particles = static_cast<std::int32_t>(swarm.particles);
  search.generations = static_cast<std::int32_t>(generations);
  search.dimension = static_cast<std::int32_t>(swarm.dimension);
  search.limbs = limbs.count;
  search.seed = seed;
  for (std::size_t d = 0; d < groups.size(); ++d) {
    const auto i = static_cast<Eigen::Index>(d);
    search.dimensions[d] = {region.start[i],  region.lower[i], region.upper[i],
                            region.spread[i], groups[d],       limbs.of_dimension[d]};
  }
  search.positions = swarm.velocity;  // with own_best after it: both are unused, as the kernel
                                      // keeps its own
  search.costs = slots_.data();
  search.answer = swarm.answer;
  return search;
}

void SwarmMemory::write(const SearchRegion& region, std::uint64_t seed) {
  const Limbs limbs(region);
  const std::vector<int> groups = groups_or_dimensions(region);
  std::uint64_t* next = frame_.data();
  *next++ = seed;
  *next++ = static_cast<std::uint64_t>(limbs.count);
  for (const auto* part : {&region.start, &region.lower, &region.upper, &region.spread}) {
    next = std::transform(part->begin(), part->end(), next,
                          [](double number) { return std::bit_cast<std::uint64_t>(number); });
  }
  for (std::size_t d = 0; d < groups.size(); ++d) {
    *next++ = std::bit_cast<std::uint64_t>(Membership{groups[d], limbs.of_dimension[d]});
  }
}

OptimizerResult SwarmMemory::answer(std::int64_t dimension) const {
  OptimizerResult result;
  result.cost = *answer_.data();
  result.point = Eigen::Map<const Eigen::VectorXd>(answer_.data() + 1, dimension);
  return result;
}

}  // namespace hypotrack::cuda
