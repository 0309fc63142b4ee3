#pragma once

#include <cstdint>
#include <string>

#include "hypotrack/optimizer.hpp"
#include "pso_params.hpp"

namespace hypotrack {

/// Particle swarm optimisation with constriction (Clerc and Kennedy, "The particle swarm:
/// explosion, stability, and convergence in a multidimensional complex space", 2002) and the
/// choices of model-based hand tracking:
/// - the swarm's best is global and changes between generations only, so that a whole generation is
///   one batch;
/// - r1 and r2 are drawn per dimension;
/// - particle 0 begins at `start` (the last solution), the others at normal samples about it with
///   standard deviation sigma * spread; velocities begin at zero;
/// - a position that leaves the bounds is truncated to them, and the velocity of that dimension
///   becomes the step that was really made, so that particles do not keep pushing at a wall.
///
/// Beyond the paper, and off by default, for regions whose groups are known:
/// - the initial particles move only a share of the groups fully (StartSpread), since a hand rarely
///   moves all of its fingers at once;
/// - every few generations a share of the particles gets one of its limbs anew (LimbReset).
///
/// The numbers r1, r2 (words 0 and 1 of uniform4) have RandomIndex{dimension, particle, generation,
/// 0}, the initial ones are those of start_sample.hpp, those of a limb anew {dimension, particle,
/// generation, 3} and {0, particle, generation, 4}. The initial generation is number 0.
///
/// The budget decides how many generations there are; the last one evaluates the first particles
/// only where the budget ends within it. `seconds` is looked at between generations.
class Pso : public Optimizer {
 public:
  /// `where` is the place of the parameters in messages. Throws ConfigError unless
  /// cognitive + social > 4.
  explicit Pso(const PsoParams& params, const std::string& where = "pso");

  std::int64_t default_evaluations() const override;
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  PsoParams params_;
  Constriction constriction_;
};

}  // namespace hypotrack
