#pragma once

#include <cstdint>
#include <string>

#include "hypotrack/plugin/optimizer.hpp"
#include "pso_params.hpp"

namespace hypotrack {

/// Particle swarm optimisation with constriction (Clerc and Kennedy, "The particle swarm:
/// explosion, stability, and convergence in a multidimensional complex space", 2002) and the usual
/// choices of model-based hand tracking:
/// - The swarm's best is global and changes between generations only, so that a whole generation is
///   one batch.
/// - r1 and r2 are drawn per dimension.
/// - Particle 0 begins at `start` (the last solution), the others at normal samples around it with
///   standard deviation sigma * spread. Velocities begin at zero.
/// - A position that leaves the bounds is clamped. The velocity of that dimension becomes the step
///   actually made, so that particles do not keep pushing against the bound.
///
/// Extensions, off by default, for regions with groups:
/// - The initial particles move only some of the groups fully (StartDistribution), since a hand
/// rarely
///   moves all its fingers at once.
/// - Every few generations some of the particles get one of their limbs replaced (LimbReset).
///
/// r1 and r2 are words 0 and 1 of uniform4 at RandomIndex{dimension, particle, generation, 0}.
/// Initial samples use the indices of random.hpp. A limb's replacement uses {dimension,
/// particle, generation, 3} and {0, particle, generation, 4}. The initial generation is number 0.
///
/// The budget determines the number of generations. If it ends within the last one, only the first
/// particles are evaluated. `seconds` is checked between generations.
class Pso : public Optimizer {
 public:
  /// `where` is the place of the parameters in messages. Throws ConfigError unless cognitive +
  /// social > 4.
  explicit Pso(const PsoParams& params, const std::string& where = "pso");

  std::int64_t default_evaluations() const override;
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  PsoParams params_;
  Constriction constriction_;
};

}  // namespace hypotrack
