#pragma once

#include <nlopt.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace hypotrack {

/// Properties of an NLopt algorithm that matter for a search.
struct NloptAlgorithm {
  enum class Bounds {
    any,      ///< respects bounds, infinite ones too
    finite,   ///< a global search: needs a finite box
    ignored,  ///< has no bounds: its points are clamped before they are evaluated
  };
  enum class Population { none, crs, isres, esch, mlsl };

  std::string_view name;  ///< as in YAML
  nlopt_algorithm id = NLOPT_LN_SBPLX;
  Bounds bounds = Bounds::any;
  Population population = Population::none;
  bool divides_boxes = false;  ///< DIRECT: memory grows with evaluations times dimension
  bool uses_gradient = false;
};

/// Returns the algorithm with a name. Throws ConfigError, beginning with `where`, which lists the
/// allowed names and says why a known NLopt algorithm is refused.
const NloptAlgorithm& find_algorithm(std::string_view name, const std::string& where);

/// Returns the algorithm with a name for the local searches of MLSL_LDS. Throws ConfigError.
const NloptAlgorithm& find_local_algorithm(std::string_view name, const std::string& where);

/// Returns a population that leaves a search of `evaluations` enough generations. NLopt's own
/// choice (280 for CRS2 and 560 for ISRES in 27 dimensions) would use up the budget before the
/// search begins.
unsigned automatic_population(NloptAlgorithm::Population rule, std::int64_t dimension,
                              std::int64_t evaluations);

}  // namespace hypotrack
