#include "track/recover/least_squares.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "hypotrack/plugin/numbers.hpp"
#include "track/search/search_cost.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kBlur = 2;                             // pixels of a silhouette's way
constexpr std::array kDampings{0.1, 1.0, 10.0, 100.0};  // factors of the steps that are tried

/// Spreads bound a step; finite differences are a share of them.
SearchSettings settings() {
  SearchSettings out;
  out.rotation_as = RotationCoordinates::tangent;
  out.position = 0.03;
  out.rotation = 20 * kDegree;
  out.angle = 30 * kDegree;
  return out;
}
constexpr double kDifference = 0.05;

}  // namespace

/// A state on its way down.
struct LeastSquares::Descent {
  Refined* at;
  SearchRegion region = {};
  Damping damping{{.first = 0.03, .least = 1e-4, .most = 1e3, .accepted = 1, .rejected = 100}};
  bool ended = false;
};

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

Eigen::VectorXd LeastSquares::differences(const SearchRegion& region) const {
  // Differences go downwards at upper bounds.
  Eigen::VectorXd steps = step_;
  for (Eigen::Index i = 0; i < steps.size(); ++i)
    if (region.start[i] + steps[i] > region.upper[i]) steps[i] = -steps[i];
  return steps;
}

NormalEquations LeastSquares::by_differences(Descent& one) {
  const Eigen::Index d = one.region.start.size();
  SearchCost cost(cost_, space_, one.at->state);
  const Eigen::VectorXd steps = differences(one.region);
  Eigen::MatrixXd points = one.region.start.replicate(1, d);
  points.diagonal() += steps;
  const auto residuals = cost.differences();
  Eigen::VectorXd at_start(1), costs(d);
  residuals->evaluate(one.region.start, at_start);
  residuals->move_to(0);
  evaluations_ += d + 1;
  const Eigen::VectorXd scale = steps.unaryExpr([](double s) { return s == 0 ? 0.0 : 1 / s; });
  return residuals->normal_equations(points, scale, costs);
}

std::vector<NormalEquations> LeastSquares::linearize(std::vector<Descent>& all) {
  std::vector<NormalEquations> out;
  if (!cost_.least_squares()->can_linearize()) {
    for (Descent& one : all) out.push_back(by_differences(one));
    return out;
  }
  std::vector<Neighbourhood> states;
  for (Descent& one : all) {
    const Eigen::VectorXd steps = differences(one.region);
    Eigen::MatrixXd points = one.region.start.replicate(1, steps.size() + 1);
    points.rightCols(steps.size()).diagonal() += steps;
    states.push_back({space_.states(points, one.at->state), steps, kBlur});
  }
  evaluations_ += std::ssize(all) * cost_.least_squares()->linearize_price(step_.size());
  return cost_.least_squares()->linearize_each(states);
}

Eigen::MatrixXd LeastSquares::trials(const Descent& one, const NormalEquations& equations) const {
  const SearchRegion& region = one.region;
  Eigen::MatrixXd out(region.start.size(), kDampings.size());
  const Eigen::VectorXd diagonal = equations.a.diagonal();
  for (std::size_t i = 0; i < kDampings.size(); ++i) {
    Eigen::MatrixXd a = equations.a;
    a.diagonal() += one.damping.value() * kDampings[i] * (diagonal.array() + 1e-9).matrix();
    Eigen::VectorXd step = a.ldlt().solve(-equations.g);
    step = step.cwiseMax(-region.spread).cwiseMin(region.spread);
    for (Eigen::Index j = 0; j < step.size(); ++j)
      if (step_[j] == 0 || !std::isfinite(step[j])) step[j] = 0;
    out.col(static_cast<Eigen::Index>(i)) =
        (region.start + step).cwiseMax(region.lower).cwiseMin(region.upper);
  }
  return out;
}

void LeastSquares::take_step(std::vector<Descent>& all) {
  for (Descent& one : all) one.region = space_.region(one.at->state);
  const std::vector<NormalEquations> equations = linearize(all);
  constexpr auto kTrials = static_cast<Eigen::Index>(kDampings.size());
  Eigen::MatrixXd states(all.front().at->state.size(), kTrials * std::ssize(all));
  for (std::size_t i = 0; i < all.size(); ++i) {
    Descent& one = all[i];
    one.ended = !equations[i].a.allFinite() || !equations[i].g.allFinite();
    auto own = states.middleCols(kTrials * static_cast<Eigen::Index>(i), kTrials);
    if (one.ended)
      own = one.at->state.replicate(1, kTrials);
    else
      own = space_.states(trials(one, equations[i]), one.at->state);
  }
  Eigen::VectorXd costs(states.cols());
  cost_.evaluate(states, costs);
  evaluations_ += states.cols();
  for (std::size_t i = 0; i < all.size(); ++i) {
    Descent& one = all[i];
    if (one.ended) continue;
    const Eigen::Index first = kTrials * static_cast<Eigen::Index>(i);
    Eigen::Index best = 0;
    const double cost = costs.segment(first, kTrials).minCoeff(&best);
    if (!(cost < one.at->cost)) {
      one.damping.reject();
      one.ended = one.damping.exhausted();
      continue;
    }
    one.at->cost = cost;
    one.at->state = states.col(first + best);
    one.damping.accept(one.damping.value() * kDampings[static_cast<std::size_t>(best)]);
  }
}

void LeastSquares::refine(std::span<Refined> states, int iterations) {
  std::vector<Descent> all;
  for (Refined& one : states) all.push_back({&one});
  for (int k = 0; k < iterations && !all.empty(); ++k) {
    take_step(all);
    std::erase_if(all, [](const Descent& one) { return one.ended; });
  }
}

}  // namespace hypotrack::internal
