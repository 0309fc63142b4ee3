#include "track/recover/least_squares.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "hypotrack/damping.hpp"
#include "track/search_cost.hpp"

namespace hypotrack {
namespace {

constexpr double kBlur = 2;         // pixels of a silhouette's way
constexpr double kFromMean = 0.05;  // share of the mean diagonal that is added to each damping

/// Spreads bound a step; finite differences are a share of them.
SearchSettings settings() {
  SearchSettings out;
  out.rotation_as = RotationSearch::tangent;
  out.position = 0.03;
  out.rotation = 20 * kDegree;
  out.angle = 30 * kDegree;
  return out;
}
constexpr double kDifference = 0.05;

}  // namespace

LeastSquares::LeastSquares(const Scene& scene, Cost& cost, const std::vector<bool>& free)
    : cost_(cost), space_(scene, settings()) {
  const SearchRegion region = space_.region(scene.rest_state());
  step_ = kDifference * region.spread;
  Eigen::Index first = 0;
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    const Eigen::Index size = scene.items()[m].model->dimension() - 1;
    if (!free[m]) step_.segment(first, size).setZero();
    first += size;
  }
}

NormalEquations LeastSquares::linearize(const SearchRegion& region, const Eigen::VectorXd& prior,
                                        Refined& state) {
  const Eigen::Index d = region.start.size();
  SearchCost cost(cost_, space_, prior);
  // Differences go downwards at upper bounds.
  Eigen::VectorXd steps = step_;
  for (Eigen::Index i = 0; i < d; ++i)
    if (region.start[i] + steps[i] > region.upper[i]) steps[i] = -steps[i];
  Eigen::MatrixXd points = region.start.replicate(1, d);
  points.diagonal() += steps;
  if (cost.can_linearize()) {
    ++state.evaluations;
    Eigen::MatrixXd all(d, d + 1);
    all << region.start, points;
    return cost.linearize(all, steps, kBlur);
  }
  const auto differences = cost.differences();
  Eigen::VectorXd at_start(1), costs(d);
  differences->evaluate(region.start, at_start);
  differences->move_to(0);
  state.evaluations += d + 1;
  const Eigen::VectorXd scale = steps.unaryExpr([](double s) { return s == 0 ? 0.0 : 1 / s; });
  return differences->normal_equations(points, scale, costs);
}

Refined LeastSquares::refine(Refined from, int iterations) {
  Damping damping({.first = 0.03, .least = 1e-4, .most = 1e3, .accepted = 1, .rejected = 100});
  for (int k = 0; k < iterations; ++k) {
    const Eigen::VectorXd prior = from.state;
    const SearchRegion region = space_.region(prior);
    const NormalEquations equations = linearize(region, prior, from);
    if (!equations.a.allFinite() || !equations.g.allFinite()) return from;
    static constexpr std::array kFactors{0.1, 1.0, 10.0, 100.0};
    Eigen::MatrixXd trials(region.start.size(), kFactors.size());
    const Eigen::VectorXd diagonal = equations.a.diagonal();
    for (std::size_t i = 0; i < kFactors.size(); ++i) {
      Eigen::MatrixXd a = equations.a;
      a.diagonal() += damping.value() * kFactors[i] *
                      (diagonal.array() + kFromMean * diagonal.mean() + 1e-9).matrix();
      Eigen::VectorXd step = a.ldlt().solve(-equations.g);
      step = step.cwiseMax(-region.spread).cwiseMin(region.spread);
      for (Eigen::Index j = 0; j < step.size(); ++j)
        if (step_[j] == 0 || !std::isfinite(step[j])) step[j] = 0;
      trials.col(static_cast<Eigen::Index>(i)) =
          (region.start + step).cwiseMax(region.lower).cwiseMin(region.upper);
    }
    const Eigen::MatrixXd states = space_.states(trials, prior);
    Eigen::VectorXd costs(states.cols());
    cost_.evaluate(states, costs);
    from.evaluations += states.cols();
    Eigen::Index best = 0;
    const double cost = costs.minCoeff(&best);
    if (!(cost < from.cost)) {
      damping.reject();
      if (damping.exhausted()) return from;
      continue;
    }
    from.cost = cost;
    from.state = states.col(best);
    damping.accept(damping.value() * kFactors[static_cast<std::size_t>(best)]);
  }
  return from;
}

}  // namespace hypotrack
