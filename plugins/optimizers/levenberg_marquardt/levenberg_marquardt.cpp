#include "levenberg_marquardt.hpp"

#include <array>

#include "least_squares_search.hpp"

namespace hypotrack {

std::span<const std::string_view> enum_names(Jacobian) {
  static constexpr std::array<std::string_view, 3> kNames{"auto", "numerical", "analytic"};
  return kNames;
}

Requirements LevenbergMarquardt::requirements() const {
  Requirements out{.least_squares = true, .jacobian = Linearization::welcome};
  if (params_.jacobian == Jacobian::numerical) out.jacobian = Linearization::unused;
  if (params_.jacobian == Jacobian::analytic) out.jacobian = Linearization::needed;
  return out;
}

OptimizerResult LevenbergMarquardt::minimize(CostFunction& cost, const SearchRegion& region,
                                             const Budget& budget, std::uint64_t) {
  check_search(cost, region, budget);
  ResidualCost* residuals = cost.residuals();
  check_requirements(requirements(), residuals, nullptr);
  return LeastSquaresSearch(cost, *residuals, region, budget, params_).run();
}

}  // namespace hypotrack
