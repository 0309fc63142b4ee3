#pragma once

#include <cstdint>
#include <pagmo/algorithm.hpp>

#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack {

/// Initial population of a generational algorithm of pagmo.
struct Population {
  Eigen::MatrixXd points;  ///< DxN, the first is the region's start; all are evaluated
  int size = 0;            ///< individuals, >= N; filled up by copies of the start
  double box = 1;          ///< how far from the start the search goes, in spreads
};

/// Searches with an algorithm of pagmo (https://esa.github.io/pagmo2). Each call of the algorithm
/// must evolve a population by one generation whose candidates do not depend on each other's costs.
///
/// pagmo asks for the cost of one candidate after the other. To evaluate a generation as one batch,
/// a copy of the algorithm first makes it and only records the candidates. Then the batch is
/// evaluated and the algorithm makes the generation with these costs. pagmo sees offsets from the
/// start in units of the spread, within the bounds and the box, and finite penalties in place of
/// infinite costs.
///
/// If the budget ends within the last generation, only its first candidates are evaluated. The
/// deadline is checked between generations. A candidate that is not finite ends the search.
OptimizerResult search_in_generations(const pagmo::algorithm& algorithm,
                                      const Population& population, CostFunction& cost,
                                      const SearchRegion& region, const Budget& budget,
                                      std::uint64_t seed);

/// Returns the 32 bits of seed for pagmo.
unsigned pagmo_seed(std::uint64_t seed);

}  // namespace hypotrack
