#pragma once

#include <algorithm>
#include <cstdint>

#include "constriction.hpp"
#include "hypotrack/random.hpp"

/// What happens to one dimension of one particle: shared by the CPU and, without Eigen, by CUDA
/// kernels.
namespace hypotrack {

inline constexpr std::uint32_t kMoveStream = 0;
inline constexpr std::uint32_t kInitialStream = 1;

/// A dimension of the search region.
struct Interval {
  double lower;
  double upper;
};

/// Where particle `particle` begins: a normal sample about `start` within the bounds.
HYPOTRACK_PIXEL double initial_position(double start, double standard_deviation,
                                        const Interval& bounds, std::uint64_t seed,
                                        std::uint32_t dimension, std::uint32_t particle) {
  const double x =
      start + standard_deviation * normal(seed, {dimension, particle, 0, kInitialStream});
  return std::clamp(x, bounds.lower, bounds.upper);
}

struct Motion {
  double position;
  double velocity;
};

/// Where a particle goes. A position that leaves the bounds is truncated to them, and the velocity
/// becomes the step that was really made.
constexpr Motion moved(const Motion& from, const Constriction& constriction, double own_best,
                       double swarm_best, double r1, double r2, const Interval& bounds) {
  const double x = from.position;
  const double v = constriction.velocity(from.velocity, own_best - x, swarm_best - x, r1, r2);
  const double position = std::clamp(x + v, bounds.lower, bounds.upper);
  return {position, position == x + v ? v : position - x};
}

}  // namespace hypotrack
