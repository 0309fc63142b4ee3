#include "ceres_optimizer.hpp"

#include <ceres/ceres.h>

#include <array>
#include <cmath>
#include <limits>

#include "reduced_problem.hpp"

namespace hypotrack {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The problem as Ceres calls it.
class Residuals final : public ceres::CostFunction {
 public:
  explicit Residuals(ReducedProblem& problem) : problem_(problem) {
    set_num_residuals(problem.residual_count());
    mutable_parameter_block_sizes()->push_back(problem.space().dimension());
  }
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    return problem_.evaluate(parameters[0], residuals, jacobians ? jacobians[0] : nullptr);
  }

 private:
  ReducedProblem& problem_;
};

/// Ends the search with the budget, or with steps that no longer matter. It measures the steps
/// itself: up to the first success, Ceres 2.2 reports every step as 0.
class Ending final : public ceres::IterationCallback {
 public:
  Ending(const ReducedProblem& problem, double tolerance)
      : problem_(problem), tolerance_(tolerance) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    const bool stepped = iteration.iteration > 0 && iteration.step_is_valid;
    const bool converged = stepped && (problem_.last_offsets() - accepted_).norm() < tolerance_;
    if (iteration.iteration == 0 || iteration.step_is_successful)
      accepted_ = problem_.last_offsets();
    return converged || problem_.finished() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                            : ceres::SOLVER_CONTINUE;
  }

 private:
  const ReducedProblem& problem_;
  double tolerance_;
  Eigen::VectorXd accepted_;
};

ceres::Solver::Options options_for(const CeresParams& params) {
  ceres::Solver::Options options;
  options.minimizer_type = ceres::TRUST_REGION;
  options.linear_solver_type = ceres::DENSE_QR;
  options.trust_region_strategy_type = params.strategy == TrustRegion::levenberg_marquardt
                                           ? ceres::LEVENBERG_MARQUARDT
                                           : ceres::DOGLEG;
  options.dogleg_type = params.strategy == TrustRegion::subspace_dogleg ? ceres::SUBSPACE_DOGLEG
                                                                        : ceres::TRADITIONAL_DOGLEG;
  options.initial_trust_region_radius = params.radius;
  // The line search at bounds: cubic interpolation would take a Jacobian for every trial.
  options.line_search_interpolation_type = ceres::QUADRATIC;
  options.max_num_iterations = std::numeric_limits<int>::max() - 1;  // the budget ends it
  options.function_tolerance = 0;                                    // so does `tolerance`
  options.gradient_tolerance = 0;
  options.parameter_tolerance = 0;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

void solve(ReducedProblem& reduced, const CeresParams& params) {
  const int n = reduced.space().dimension();
  Residuals residuals(reduced);
  Ending ending(reduced, params.tolerance);
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  Eigen::VectorXd offsets = Eigen::VectorXd::Zero(n);
  problem.AddResidualBlock(&residuals, nullptr, offsets.data());
  const Eigen::VectorXd lower = reduced.space().lower(kInfinity);
  const Eigen::VectorXd upper = reduced.space().upper(kInfinity);
  for (int i = 0; i < n; ++i) {
    if (std::isfinite(lower[i])) problem.SetParameterLowerBound(offsets.data(), i, lower[i]);
    if (std::isfinite(upper[i])) problem.SetParameterUpperBound(offsets.data(), i, upper[i]);
  }
  ceres::Solver::Options options = options_for(params);
  options.callbacks.push_back(&ending);
  ceres::Solver::Summary summary;
  // Its verdict does not matter: the problem keeps the best point.
  ceres::Solve(options, &problem, &summary);
  reduced.rethrow();
}

}  // namespace

std::span<const std::string_view> enum_names(TrustRegion) {
  static constexpr std::array<std::string_view, 3> kNames{"levenberg_marquardt", "dogleg",
                                                          "subspace_dogleg"};
  return kNames;
}

OptimizerResult CeresOptimizer::minimize(CostFunction& cost, const SearchRegion& region,
                                         const Budget& budget, std::uint64_t /*seed*/) {
  check_search(cost, region, budget);
  check_requirements(requirements(), cost.residuals(), nullptr);
  return from_feasible_start(cost, region, budget, params_.linearization.difference,
                             [&](const SearchRegion& from, const Budget& rest) {
                               ReducedProblem problem(cost, from, rest, params_.linearization);
                               problem.evaluate_start();
                               if (problem.space().dimension() > 0 && !problem.finished())
                                 solve(problem, params_);
                               return problem.result();
                             });
}

}  // namespace hypotrack
