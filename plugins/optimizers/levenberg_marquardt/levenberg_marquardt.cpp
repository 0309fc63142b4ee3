#include "levenberg_marquardt.hpp"

#include "hypotrack/error.hpp"
#include "least_squares_search.hpp"

namespace hypotrack {

OptimizerResult LevenbergMarquardt::minimize(CostFunction& cost, const SearchRegion& region,
                                             const Budget& budget, std::uint64_t) {
  check_search(cost, region, budget);
  ResidualCost* residuals = cost.residuals();
  if (!residuals) {
    throw ConfigError(
        "optimizer levenberg_marquardt: this cost has no residuals; take an optimizer that needs "
        "costs only, such as `optimizer: {type: pso}`");
  }
  return LeastSquaresSearch(*residuals, region, budget, params_).run();
}

}  // namespace hypotrack
