#include "nlopt_optimizer.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <type_traits>

#include "hypotrack/api/error.hpp"
#include "scaled_problem.hpp"

namespace hypotrack {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
// A box of DIRECT holds about 3 doubles per evaluation and dimension.
constexpr std::int64_t kMaxDirectNumbers = std::int64_t{1} << 25;

struct Destroy {
  void operator()(nlopt_opt opt) const { nlopt_destroy(opt); }
};
using NloptHandle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, Destroy>;

int to_int(std::int64_t value) {
  return static_cast<int>(std::min<std::int64_t>(value, std::numeric_limits<int>::max()));
}

NloptHandle create(nlopt_algorithm algorithm, const ScaledProblem& problem,
                   const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                   const NloptParams& params) {
  NloptHandle opt(nlopt_create(algorithm, static_cast<unsigned>(problem.dimension())));
  if (!opt) throw std::bad_alloc();
  nlopt_set_lower_bounds(opt.get(), lower.data());
  nlopt_set_upper_bounds(opt.get(), upper.data());
  // BOBYQA refuses steps above half the distance between the bounds.
  const Eigen::VectorXd step = (0.49 * (upper - lower)).cwiseMin(params.step);
  nlopt_set_initial_step(opt.get(), step.data());
  if (params.tolerance > 0) nlopt_set_xtol_abs1(opt.get(), params.tolerance);
  return opt;
}

}  // namespace

Nlopt::Nlopt(const NloptParams& params, const std::string& where)
    : params_(params),
      where_(where),
      algorithm_(&find_algorithm(params.algorithm, where)),
      local_(&find_local_algorithm(params.local, where)) {}

bool Nlopt::uses_gradient() const {
  const bool searches_locally = algorithm_->population == NloptAlgorithm::Population::mlsl;
  return algorithm_->uses_gradient || (searches_locally && local_->uses_gradient);
}

Requirements Nlopt::requirements() const {
  if (!uses_gradient()) return {};
  return {.least_squares = true, .jacobian = Linearization::welcome};
}

void Nlopt::check(const ScaledProblem& problem) const {
  const std::int64_t n = problem.dimension();
  if (algorithm_->divides_boxes && problem.remaining() > kMaxDirectNumbers / n) {
    throw ConfigError(where_ + ": " + params_.algorithm + " keeps a box per evaluation; " +
                      std::to_string(problem.remaining()) + " evaluations in " + std::to_string(n) +
                      " dimensions need over 1 GiB, expected at most " +
                      std::to_string(kMaxDirectNumbers / n) + " evaluations");
  }
  if (algorithm_->population == NloptAlgorithm::Population::crs && params_.population > 0 &&
      params_.population <= n) {
    throw ConfigError(where_ + ": population is " + std::to_string(params_.population) +
                      ", expected more than the search's " + std::to_string(n) +
                      " dimensions for CRS2_LM, or 0 (automatic)");
  }
}

void Nlopt::run(ScaledProblem& problem) const {
  const bool boxed = algorithm_->bounds == NloptAlgorithm::Bounds::finite;
  const bool unbounded = algorithm_->bounds == NloptAlgorithm::Bounds::ignored;
  const int n = problem.dimension();
  const double box = boxed ? params_.box : kUnbounded;
  const Eigen::VectorXd lower =
      unbounded ? Eigen::VectorXd::Constant(n, -kUnbounded) : problem.lower(box);
  const Eigen::VectorXd upper =
      unbounded ? Eigen::VectorXd::Constant(n, kUnbounded) : problem.upper(box);

  const NloptHandle opt = create(algorithm_->id, problem, lower, upper, params_);
  // Algorithms size their memory by it; the problem stops them.
  nlopt_set_maxeval(opt.get(), to_int(problem.remaining() + 2 * n + 2));
  if (algorithm_->population != NloptAlgorithm::Population::none) {
    nlopt_set_population(
        opt.get(), params_.population > 0
                       ? static_cast<unsigned>(params_.population)
                       : automatic_population(algorithm_->population, n, problem.remaining()));
  }
  if (algorithm_->population == NloptAlgorithm::Population::mlsl) {
    const NloptHandle local = create(local_->id, problem, lower, upper, params_);
    nlopt_set_maxeval(local.get(), to_int(std::max<std::int64_t>(problem.remaining() / 2, 1)));
    nlopt_set_local_optimizer(opt.get(), local.get());
  }
  problem.attach(opt.get());
  nlopt_set_min_objective(opt.get(), &ScaledProblem::callback, &problem);

  Eigen::VectorXd offsets = Eigen::VectorXd::Zero(n);
  double value = 0;
  const nlopt_result code = nlopt_optimize(opt.get(), offsets.data(), &value);
  problem.rethrow();
  if (code == NLOPT_INVALID_ARGS || code == NLOPT_OUT_OF_MEMORY) {
    const char* message = nlopt_get_errmsg(opt.get());
    throw Error(where_ + ": NLopt's " + params_.algorithm + " failed in " + std::to_string(n) +
                " dimensions: " + nlopt_result_to_string(code) +
                (message ? std::string(": ") + message : std::string()));
  }
}

OptimizerResult Nlopt::search(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                              std::uint64_t seed) const {
  ScaledProblem problem(cost, region, budget);
  if (uses_gradient()) problem.use_gradient(params_.gradient);
  if (problem.dimension() > 0) check(problem);
  problem.evaluate_start();
  if (problem.dimension() > 0 && problem.remaining() > 0) {
    // NLopt has one generator per thread, with 32 bits of seed.
    nlopt_srand(static_cast<unsigned long>((seed ^ (seed >> 32)) & 0xffffffffu));
    run(problem);
  }
  return problem.result();
}

OptimizerResult Nlopt::minimize(CostFunction& cost, const SearchRegion& region,
                                const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  if (!uses_gradient()) return search(cost, region, budget, seed);
  check_requirements(requirements(), cost.residuals(), nullptr);
  return from_feasible_start(
      cost, region, budget, params_.gradient.difference,
      [&](const SearchRegion& from, const Budget& rest) { return search(cost, from, rest, seed); });
}

}  // namespace hypotrack
