#include "generations.hpp"

#include <algorithm>
#include <cmath>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <span>
#include <utility>
#include <vector>

#include "hypotrack/plugin/offset_space.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {
namespace {

using pagmo::vector_double;

/// The candidates of a generation, and their costs once they are known.
struct Exchange {
  std::size_t size = 0;  ///< candidates of a generation
  std::vector<vector_double> asked;
  std::vector<double> answers;  ///< empty in the rehearsal
  std::size_t answered = 0;
};

/// Exception that ends a rehearsal when all candidates are known.
struct Rehearsed {};

/// pagmo's view of the search.
struct OffsetProblem {
  Exchange* exchange = nullptr;
  vector_double lower = {0}, upper = {1};  // pagmo also makes a problem without a search

  vector_double fitness(const vector_double& offsets) const {
    if (!exchange->answers.empty()) return {exchange->answers.at(exchange->answered++)};
    exchange->asked.push_back(offsets);
    if (exchange->asked.size() == exchange->size) throw Rehearsed{};
    return {0.0};
  }
  std::pair<vector_double, vector_double> get_bounds() const { return {lower, upper}; }
};

vector_double to_pagmo(const Eigen::VectorXd& offsets) { return {offsets.begin(), offsets.end()}; }

/// Returns the candidates of the next generation, without changing the algorithm.
std::vector<vector_double> rehearse(pagmo::algorithm algorithm, const pagmo::population& population,
                                    Exchange& exchange) {
  exchange.asked.clear();
  exchange.answers.clear();
  try {
    (void)algorithm.evolve(population);
  } catch (const Rehearsed&) {
  }
  return std::exchange(exchange.asked, {});
}

/// Evaluates search points and counts evaluations.
class Evaluations {
 public:
  Evaluations(CostFunction& cost, const OffsetSpace& space, std::int64_t limit)
      : cost_(cost), space_(space), limit_(limit) {}

  std::int64_t left() const { return limit_ - best_.result().evaluations; }
  const OptimizerResult& best() const { return best_.result(); }

  /// Returns finite costs of the first points, as many as the budget allows.
  std::vector<double> of_points(const Eigen::MatrixXd& points) {
    const auto count = std::min<std::int64_t>(points.cols(), left());
    Eigen::VectorXd costs(count);
    cost_.evaluate(points.leftCols(count), costs);
    best_.update(points.leftCols(count), costs);
    std::vector<double> finite;
    for (const double each : costs) finite.push_back(finite_.of(each));
    return finite;
  }
  std::vector<double> of_offsets(const std::vector<vector_double>& offsets, Eigen::Index d) {
    Eigen::MatrixXd points(d, static_cast<Eigen::Index>(offsets.size()));
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      points.col(static_cast<Eigen::Index>(i)) = space_.point(offsets[i]);
    }
    return of_points(points);
  }

 private:
  CostFunction& cost_;
  const OffsetSpace& space_;
  std::int64_t limit_;
  BestSoFar best_;
  FiniteCosts finite_;
};

/// Evaluates the first generation. Returns false if the budget ended within it.
bool begin(const Population& from, const OffsetSpace& space, Evaluations& evaluations,
           pagmo::population& population) {
  const Eigen::VectorXd lower = space.lower(from.box), upper = space.upper(from.box);
  const std::vector<double> costs = evaluations.of_points(from.points);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const Eigen::VectorXd offsets = space.offsets(from.points.col(static_cast<Eigen::Index>(i)));
    population.push_back(to_pagmo(offsets.cwiseMax(lower).cwiseMin(upper)), {costs[i]});
  }
  while (population.size() < static_cast<std::size_t>(from.size)) {
    population.push_back(population.get_x()[0], population.get_f()[0]);
  }
  return evaluations.left() > 0;
}

bool all_finite(const std::vector<vector_double>& candidates) {
  return std::ranges::all_of(candidates, [](const vector_double& x) {
    return std::ranges::all_of(x, [](double each) { return std::isfinite(each); });
  });
}

}  // namespace

unsigned pagmo_seed(std::uint64_t seed) {
  return static_cast<unsigned>((seed ^ (seed >> 32)) & 0xffffffffu);
}

OptimizerResult search_in_generations(const pagmo::algorithm& algorithm, const Population& from,
                                      CostFunction& cost, const SearchRegion& region,
                                      const Budget& budget, std::uint64_t seed) {
  const Deadline deadline(budget.seconds);
  const OffsetSpace space(region);
  Evaluations evaluations(cost, space, budget.evaluations);
  if (space.dimension() == 0) {
    evaluations.of_points(region.start);
    return evaluations.best();
  }

  Exchange exchange{static_cast<std::size_t>(from.size), {}, {}, 0};
  pagmo::population population(
      OffsetProblem{&exchange, to_pagmo(space.lower(from.box)), to_pagmo(space.upper(from.box))},
      0u, pagmo_seed(seed));
  if (!begin(from, space, evaluations, population)) return evaluations.best();
  while (evaluations.left() > 0 && !deadline.passed()) {
    const auto candidates = rehearse(algorithm, population, exchange);
    if (!all_finite(candidates)) break;
    exchange.answers = evaluations.of_offsets(candidates, region.start.size());
    if (exchange.answers.size() < exchange.size) break;
    exchange.answered = 0;
    population = algorithm.evolve(population);
  }
  return evaluations.best();
}

}  // namespace hypotrack
