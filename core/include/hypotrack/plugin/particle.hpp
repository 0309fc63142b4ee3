#pragma once

#include <algorithm>
#include <cstdint>

#include "hypotrack/plugin/random.hpp"

/// Motion of one dimension of one particle, shared by the CPU and CUDA kernels; without Eigen.
namespace hypotrack {

inline constexpr std::uint32_t kMoveStream = 0;
inline constexpr std::uint32_t kResetStream = 3;
inline constexpr std::uint32_t kResetLimbStream = 4;

/// Coefficients of particle swarm optimization with constriction (Clerc and Kennedy 2002).
struct Constriction {
  double cognitive = 0;
  double social = 0;
  double factor = 0;  ///< K

  /// Returns v' = K (v + c1 r1 (own best - x) + c2 r2 (swarm's best - x)) for one dimension of one
  /// particle.
  constexpr double velocity(double v, double to_own_best, double to_swarm_best, double r1,
                            double r2) const {
    return factor * (v + cognitive * r1 * to_own_best + social * r2 * to_swarm_best);
  }
  bool operator==(const Constriction&) const = default;
};

/// Position and velocity of a particle in one dimension.
struct Motion {
  double position;
  double velocity;
};

/// Moves a particle by one generation, in one dimension. The position is clamped to the bounds, and
/// the velocity then becomes the step actually made.
constexpr Motion moved(const Motion& from, const Constriction& constriction, double own_best,
                       double swarm_best, double r1, double r2, const Interval& bounds) {
  const double x = from.position;
  const double v = constriction.velocity(from.velocity, own_best - x, swarm_best - x, r1, r2);
  const double position = std::clamp(x + v, bounds.lower, bounds.upper);
  return {position, position == x + v ? v : position - x};
}

/// Periodic resampling of one limb in a share of the particles. Without it, the swarm collapses
/// first in the many small dimensions. After Oikonomidis, Kyriazis and Argyros 2012.
struct LimbReset {
  int every = 0;       ///< generations; 0 = never
  double share = 0.5;  ///< share of the particles

  constexpr bool due(std::uint32_t generation) const {
    return every > 0 && generation > 0 && generation % static_cast<std::uint32_t>(every) == 0;
  }
  /// Returns the limb (0 to `limbs` - 1) that a particle resamples in a generation that is due; -1
  /// = none. Requires `limbs` >= 1.
  HYPOTRACK_PIXEL int limb(std::uint64_t seed, std::uint32_t particle, std::uint32_t generation,
                           int limbs) const {
    const auto u = uniform4(seed, {0, particle, generation, kResetLimbStream});
    if (!(u[0] < share)) return -1;
    return std::min(static_cast<int>(u[1] * limbs), limbs - 1);
  }
};

/// Returns the normal offset from the swarm's best for one dimension of a resampled limb. `index`
/// is that of the move that it replaces.
HYPOTRACK_PIXEL double anew_offset(double standard_deviation, std::uint64_t seed,
                                   RandomIndex index) {
  index.stream = kResetStream;
  return standard_deviation * normal(seed, index);
}
/// Places one dimension of a resampled limb within the bounds, with zero velocity.
constexpr Motion placed_anew(double swarm_best, double offset, const Interval& bounds) {
  return {std::clamp(swarm_best + offset, bounds.lower, bounds.upper), 0.0};
}

}  // namespace hypotrack
