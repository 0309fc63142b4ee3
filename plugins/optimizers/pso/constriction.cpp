#include "constriction.hpp"

#include <cmath>

#include "hypotrack/api/error.hpp"

namespace hypotrack {

Constriction make_constriction(double cognitive, double social, const std::string& where) {
  const double psi = cognitive + social;
  if (!(psi > 4)) {
    throw ConfigError(where + ": cognitive + social is " + std::to_string(psi) +
                      ", expected above 4: the swarm is only constricted (and its search sure to "
                      "settle) there; the defaults are 2.8 and 1.3");
  }
  return {cognitive, social, 2.0 / std::abs(2.0 - psi - std::sqrt(psi * psi - 4.0 * psi))};
}

}  // namespace hypotrack
