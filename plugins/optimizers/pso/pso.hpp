#pragma once

#include <cstdint>
#include <string>

#include "hypotrack/optimizer.hpp"
#include "hypotrack/params.hpp"

namespace hypotrack {

struct PsoParams {
  int particles = 64;
  int generations = 64;
  double sigma = 0.5;
  double cognitive = 2.8;
  double social = 1.3;
  void visit(ParamVisitor& v) {
    v("particles", particles,
      {.help = "particles of the swarm, evaluated as one batch", .min = 1, .max = 1 << 20});
    v("generations", generations,
      {.help = "generations, the initial one included, where the scene names no budget",
       .min = 1,
       .max = 1 << 20});
    v("sigma", sigma,
      {.help = "standard deviation of the initial particles, as a share of the search region's "
               "spread",
       .min = 0,
       .max = 10});
    v("cognitive", cognitive,
      {.help = "c1, pull of a particle's own best; cognitive + social must be above 4",
       .min = 0,
       .max = 100});
    v("social", social, {.help = "c2, pull of the swarm's best", .min = 0, .max = 100});
  }
};

/// Coefficients of a swarm with constriction.
struct Constriction {
  double cognitive = 0;
  double social = 0;
  double factor = 0;  ///< K

  /// K = 2 / |2 - psi - sqrt(psi^2 - 4 psi)| with psi = cognitive + social (Clerc and Kennedy
  /// 2002). Throws ConfigError, naming `where`, unless psi > 4.
  static Constriction from(double cognitive, double social, const std::string& where);

  /// v' = K (v + c1 r1 (own best - x) + c2 r2 (swarm's best - x)), one dimension of one particle.
  double velocity(double v, double to_own_best, double to_swarm_best, double r1, double r2) const {
    return factor * (v + cognitive * r1 * to_own_best + social * r2 * to_swarm_best);
  }
};

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
/// The numbers r1, r2 (words 0 and 1 of uniform4) have RandomIndex{dimension, particle, generation,
/// 0}, the initial normal numbers {dimension, particle, 0, 1}. The initial generation is number 0.
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
