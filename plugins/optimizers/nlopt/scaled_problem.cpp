#include "scaled_problem.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace hypotrack {
namespace {

// Calls of NLopt without an evaluation (the start again, an offset that is NaN) that count as an
// endless loop.
constexpr std::int64_t kMaxIdleCalls = 10000;

}  // namespace

ScaledProblem::ScaledProblem(CostFunction& cost, const SearchRegion& region, const Budget& budget)
    : cost_(cost),
      region_(region),
      limit_(budget.evaluations),
      deadline_(budget.seconds),
      space_(region) {}

void ScaledProblem::use_gradient(const LinearizationParams& params) {
  linearizer_.emplace(cost_, region_, params, best_);
}

double ScaledProblem::evaluate(const Eigen::VectorXd& point) {
  if (linearizer_) {
    last_cost_ = linearizer_->evaluate(point);
  } else {
    Eigen::VectorXd cost(1);
    cost_.evaluate(point, cost);
    best_.update(point, cost);
    last_cost_ = cost[0];
  }
  return finite_.of(last_cost_);
}

void ScaledProblem::evaluate_start() { start_value_ = evaluate(region_.start); }

void ScaledProblem::stop() {
  stopped_ = true;
  // ORIG_DIRECT_L of NLopt 2.7.1 crashes if its first call stops it; stop it in the second.
  if (calls_ > 1) nlopt_force_stop(opt_);
}

double ScaledProblem::value(const double* offsets, Eigen::VectorXd* gradient) {
  ++calls_;
  const std::span point_offsets(offsets, static_cast<std::size_t>(dimension()));
  const bool broken = std::ranges::any_of(point_offsets, [](double u) { return std::isnan(u); });
  const bool start = std::ranges::all_of(point_offsets, [](double u) { return u == 0.0; });
  if (stopped_ || broken || (start && !gradient)) {
    // Some algorithms check the stop flag late; until then their calls cost nothing.
    if (stopped_ || ++idle_calls_ > kMaxIdleCalls) stop();
    return start ? start_value_ : std::max(FiniteCosts::kUnknown, finite_.worst() * 2);
  }
  const Eigen::VectorXd point = space_.point(point_offsets);
  // SLSQP asks for the value first and for the gradient when it has accepted the point.
  const bool known = gradient && linearizer_->point() == point;
  const double value = known ? finite_.of(last_cost_) : evaluate(point);
  if (gradient) add_gradient(*gradient);
  if (remaining() <= 0 || deadline_.passed()) stop();
  return value;
}

void ScaledProblem::add_gradient(Eigen::VectorXd& gradient) {
  if (!std::isfinite(last_cost_)) return;
  if (remaining() < linearizer_->price()) return stop();
  gradient += 2 * space_.free_part(linearizer_->equations().g);
}

double ScaledProblem::callback(unsigned n, const double* offsets, double* gradient, void* data) {
  auto& problem = *static_cast<ScaledProblem*>(data);
  Eigen::VectorXd own = Eigen::VectorXd::Zero(n);
  double value = FiniteCosts::kUnknown;
  try {
    value = problem.value(offsets, gradient ? &own : nullptr);
  } catch (...) {  // must not pass through NLopt's C frames
    problem.error_ = std::current_exception();
    problem.stop();
  }
  if (gradient) std::ranges::copy(own, gradient);
  return value;
}

void ScaledProblem::rethrow() const {
  if (error_) std::rethrow_exception(error_);
}

}  // namespace hypotrack
