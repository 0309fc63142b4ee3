#include "cma_es.hpp"

#include <pagmo/algorithms/cmaes.hpp>

#include "generations.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {

OptimizerResult CmaEs::minimize(CostFunction& cost, const SearchRegion& region,
                                const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  constexpr double kAutomatic = -1;
  constexpr double kNeverConverged = 0;  // the budget decides
  constexpr bool kMemory = true, kForceBounds = true;
  // pagmo's first covariance has the width of the bounds, which is 2 box in most dimensions.
  const double sigma = params_.sigma / (2 * params_.box);
  const pagmo::algorithm algorithm(pagmo::cmaes(1, kAutomatic, kAutomatic, kAutomatic, kAutomatic,
                                                sigma, kNeverConverged, kNeverConverged, kMemory,
                                                kForceBounds, pagmo_seed(seed)));
  return search_in_generations(algorithm, {region.start, params_.population, params_.box}, cost,
                               region, budget, seed);
}

}  // namespace hypotrack
