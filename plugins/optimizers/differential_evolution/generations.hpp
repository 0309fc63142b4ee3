#pragma once

#include <cstdint>
#include <pagmo/algorithm.hpp>

#include "hypotrack/optimizer.hpp"

namespace hypotrack {

/// How a generational algorithm of pagmo begins.
struct Population {
  Eigen::MatrixXd points;  ///< DxN, the first one the region's start; all are evaluated
  int size = 0;            ///< individuals, >= N; copies of the start fill up what is missing
  double box = 1;          ///< how far from the start the search goes, in spreads
};

/// Searches with an algorithm of pagmo (https://esa.github.io/pagmo2) that evolves a population by
/// one generation per call, and whose candidates do not depend on each other's costs within it.
///
/// pagmo asks for the cost of one candidate after the other. Here a generation is rehearsed by a
/// copy of the algorithm that only writes down what it asks for; all of that is evaluated as one
/// batch; then the algorithm itself makes the generation with these costs. pagmo sees offsets from
/// the start in units of the spread, within the bounds and the box, and finite penalties in the
/// place of infinite costs.
///
/// The last generation evaluates its first candidates only where the budget ends within it; time is
/// looked at between generations. A generation with a candidate that is not finite ends the search.
OptimizerResult search_in_generations(const pagmo::algorithm& algorithm,
                                      const Population& population, CostFunction& cost,
                                      const SearchRegion& region, const Budget& budget,
                                      std::uint64_t seed);

/// The 32 bits of seed that pagmo takes.
unsigned pagmo_seed(std::uint64_t seed);

}  // namespace hypotrack
