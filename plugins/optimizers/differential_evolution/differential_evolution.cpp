#include "differential_evolution.hpp"

#include <array>
#include <pagmo/algorithms/de.hpp>

#include "generations.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {

std::span<const std::string_view> enum_names(DifferentialVariant) {
  static constexpr std::array<std::string_view, 10> names{
      "best_1_exp", "rand_1_exp", "rand_to_best_1_exp", "best_2_exp", "rand_2_exp",
      "best_1_bin", "rand_1_bin", "rand_to_best_1_bin", "best_2_bin", "rand_2_bin"};
  return names;
}

OptimizerResult DifferentialEvolution::minimize(CostFunction& cost, const SearchRegion& region,
                                                const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  constexpr double kNeverConverged = 0;  // the budget decides
  const pagmo::algorithm algorithm(pagmo::de(1, params_.weight, params_.crossover,
                                             static_cast<unsigned>(params_.variant) + 1,
                                             kNeverConverged, kNeverConverged, pagmo_seed(seed)));
  SearchRegion boxed = region;
  boxed.lower = region.lower.cwiseMax(region.start - params_.box * region.spread);
  boxed.upper = region.upper.cwiseMin(region.start + params_.box * region.spread);
  const Population from{StartPoints(boxed, params_.start, seed).points(0, params_.population),
                        params_.population, params_.box};
  return search_in_generations(algorithm, from, cost, region, budget, seed);
}

}  // namespace hypotrack
