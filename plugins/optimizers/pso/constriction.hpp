#pragma once

#include <string>

#include "hypotrack/plugin/particle.hpp"

namespace hypotrack {

/// Computes K = 2 / |2 - psi - sqrt(psi^2 - 4 psi)| with psi = cognitive + social (Clerc and
/// Kennedy 2002). Throws ConfigError, naming `where`, unless psi > 4.
Constriction make_constriction(double cognitive, double social, const std::string& where);

}  // namespace hypotrack
