#pragma once

#include <string>

namespace hypotrack {

/// Coefficients of a swarm with constriction.
struct Constriction {
  double cognitive = 0;
  double social = 0;
  double factor = 0;  ///< K

  /// K = 2 / |2 - psi - sqrt(psi^2 - 4 psi)| with psi = cognitive + social (Clerc and Kennedy
  /// 2002). Throws ConfigError, naming `where`, unless psi > 4.
  static Constriction from(double cognitive, double social, const std::string& where);

  /// v' = K (v + c1 r1 (own best - x) + c2 r2 (swarm's best - x)), one dimension of one particle.
  constexpr double velocity(double v, double to_own_best, double to_swarm_best, double r1,
                            double r2) const {
    return factor * (v + cognitive * r1 * to_own_best + social * r2 * to_swarm_best);
  }
};

}  // namespace hypotrack
