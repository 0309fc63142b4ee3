#include "scaled_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace hypotrack {
namespace {

// Infeasible before any feasible cost is known.
constexpr double kPenaltyUnknown = 1e10;
// Calls of NLopt that cost no evaluation (the start again, an offset that is NaN) before it is
// taken to be caught in a loop.
constexpr std::int64_t kMaxIdleCalls = 10000;

}  // namespace

ScaledProblem::ScaledProblem(CostFunction& cost, const SearchRegion& region, const Budget& budget)
    : cost_(cost),
      region_(region),
      limit_(budget.evaluations),
      deadline_(budget.seconds),
      worst_(std::numeric_limits<double>::quiet_NaN()) {
  for (Eigen::Index d = 0; d < region.start.size(); ++d) {
    if (region.lower[d] < region.upper[d]) free_.push_back(d);
  }
}

Eigen::VectorXd ScaledProblem::lower(double box) const {
  Eigen::VectorXd bounds(dimension());
  for (int i = 0; i < dimension(); ++i) {
    const Eigen::Index d = free_[i];
    bounds[i] = std::max(-box, (region_.lower[d] - region_.start[d]) / region_.spread[d]);
  }
  return bounds;
}

Eigen::VectorXd ScaledProblem::upper(double box) const {
  Eigen::VectorXd bounds(dimension());
  for (int i = 0; i < dimension(); ++i) {
    const Eigen::Index d = free_[i];
    bounds[i] = std::min(box, (region_.upper[d] - region_.start[d]) / region_.spread[d]);
  }
  return bounds;
}

Eigen::VectorXd ScaledProblem::point(const double* offsets) const {
  Eigen::VectorXd point = region_.start;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    point[free_[i]] += region_.spread[free_[i]] * offsets[i];
  }
  return within_bounds(point, region_);
}

double ScaledProblem::evaluate(const Eigen::VectorXd& point) {
  Eigen::VectorXd cost(1);
  cost_.evaluate(point, cost);
  best_.update(point, cost);
  if (!std::isfinite(cost[0])) {
    // Clearly worse than anything seen, in the scale of what was seen: models that an algorithm
    // fits to its points stay usable.
    if (std::isnan(worst_)) return kPenaltyUnknown;
    return worst_ + (worst_ - best_.result().cost) + std::abs(worst_) + 1.0;
  }
  worst_ = std::fmax(worst_, cost[0]);
  return cost[0];
}

void ScaledProblem::evaluate_start() { start_value_ = evaluate(region_.start); }

void ScaledProblem::stop() {
  stopped_ = true;
  // ORIG_DIRECT_L of NLopt 2.7.1 crashes when told to stop by its first call; the second one tells
  // it.
  if (calls_ > 1) nlopt_force_stop(opt_);
}

double ScaledProblem::value(const double* offsets) {
  ++calls_;
  const std::span point_offsets(offsets, free_.size());
  const bool broken = std::ranges::any_of(point_offsets, [](double u) { return std::isnan(u); });
  const bool start = std::ranges::all_of(point_offsets, [](double u) { return u == 0.0; });
  if (stopped_ || broken || start) {
    // Some algorithms look at the stop flag late only; meanwhile their calls cost nothing.
    if (stopped_ || ++idle_calls_ > kMaxIdleCalls) stop();
    return start ? start_value_ : std::max(kPenaltyUnknown, std::fmax(worst_, 0.0) * 2);
  }
  const double value = evaluate(point(offsets));
  if (remaining() <= 0 || deadline_.passed()) stop();
  return value;
}

double ScaledProblem::callback(unsigned /*n*/, const double* offsets, double* /*gradient*/,
                               void* data) {
  auto& problem = *static_cast<ScaledProblem*>(data);
  try {
    return problem.value(offsets);
  } catch (...) {  // must not pass through NLopt's C frames
    problem.error_ = std::current_exception();
    problem.stop();
    return kPenaltyUnknown;
  }
}

void ScaledProblem::rethrow() const {
  if (error_) std::rethrow_exception(error_);
}

}  // namespace hypotrack
