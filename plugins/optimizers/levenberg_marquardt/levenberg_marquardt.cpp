#include "levenberg_marquardt.hpp"

#include <array>

#include "hypotrack/error.hpp"
#include "least_squares_search.hpp"

namespace hypotrack {

std::span<const std::string_view> enum_names(Jacobian) {
  static constexpr std::array<std::string_view, 3> kNames{"auto", "numerical", "analytic"};
  return kNames;
}

Linearization LevenbergMarquardt::linearization() const {
  switch (params_.jacobian) {
    case Jacobian::numerical:
      return Linearization::unused;
    case Jacobian::analytic:
      return Linearization::needed;
    case Jacobian::automatic:
      break;
  }
  return Linearization::welcome;
}

OptimizerResult LevenbergMarquardt::minimize(CostFunction& cost, const SearchRegion& region,
                                             const Budget& budget, std::uint64_t) {
  check_search(cost, region, budget);
  ResidualCost* residuals = cost.residuals();
  if (!residuals) {
    throw ConfigError(
        "optimizer levenberg_marquardt: this cost has no residuals; take an optimizer that needs "
        "costs only, such as `optimizer: {type: pso}`");
  }
  if (params_.jacobian == Jacobian::analytic && !residuals->can_linearize()) {
    throw ConfigError(
        "optimizer levenberg_marquardt: jacobian: analytic: a term of this cost has no slopes of "
        "its residuals, or the backend does not draw on the CPU; write `jacobian: auto`");
  }
  return LeastSquaresSearch(cost, *residuals, region, budget, params_).run();
}

}  // namespace hypotrack
