#include "pso.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hypotrack/error.hpp"
#include "hypotrack/random.hpp"
#include "hypotrack/search.hpp"

namespace hypotrack {
namespace {

constexpr std::uint32_t kMoveStream = 0;
constexpr std::uint32_t kInitialStream = 1;

RandomIndex random_index(Eigen::Index dimension, Eigen::Index particle, std::uint32_t generation,
                         std::uint32_t stream) {
  return {static_cast<std::uint32_t>(dimension), static_cast<std::uint32_t>(particle), generation,
          stream};
}

/// Positions, velocities and what each particle found, DxN.
struct Swarm {
  Eigen::MatrixXd position;
  Eigen::MatrixXd velocity;
  Eigen::MatrixXd own_best;
  Eigen::VectorXd own_best_cost;

  Swarm(const SearchRegion& region, Eigen::Index particles, double sigma, std::uint64_t seed)
      : position(region.start.replicate(1, particles)),
        velocity(Eigen::MatrixXd::Zero(region.start.size(), particles)),
        own_best_cost(
            Eigen::VectorXd::Constant(particles, std::numeric_limits<double>::infinity())) {
    for (Eigen::Index p = 1; p < particles; ++p) {
      for (Eigen::Index d = 0; d < position.rows(); ++d) {
        position(d, p) +=
            sigma * region.spread[d] * normal(seed, random_index(d, p, 0, kInitialStream));
      }
      position.col(p) = within_bounds(position.col(p), region);
    }
    own_best = position;
  }

  void move(const Constriction& constriction, const SearchRegion& region,
            const Eigen::VectorXd& swarm_best, std::uint32_t generation, std::uint64_t seed) {
    for (Eigen::Index p = 0; p < position.cols(); ++p) {
      for (Eigen::Index d = 0; d < position.rows(); ++d) {
        const auto r = uniform4(seed, random_index(d, p, generation, kMoveStream));
        const double x = position(d, p);
        const double v = constriction.velocity(velocity(d, p), own_best(d, p) - x,
                                               swarm_best[d] - x, r[0], r[1]);
        const double moved = std::clamp(x + v, region.lower[d], region.upper[d]);
        velocity(d, p) = moved == x + v ? v : moved - x;
        position(d, p) = moved;
      }
    }
  }

  /// Takes in the costs of the first particles.
  void remember(const Eigen::Ref<const Eigen::VectorXd>& costs) {
    for (Eigen::Index p = 0; p < costs.size(); ++p) {
      if (costs[p] < own_best_cost[p]) {
        own_best_cost[p] = costs[p];
        own_best.col(p) = position.col(p);
      }
    }
  }
};

}  // namespace

Constriction Constriction::from(double cognitive, double social, const std::string& where) {
  const double psi = cognitive + social;
  if (!(psi > 4)) {
    throw ConfigError(where + ": cognitive + social is " + std::to_string(psi) +
                      ", expected above 4: the swarm is only constricted (and its search sure to "
                      "settle) there; the defaults are 2.8 and 1.3");
  }
  return {cognitive, social, 2.0 / std::abs(2.0 - psi - std::sqrt(psi * psi - 4.0 * psi))};
}

Pso::Pso(const PsoParams& params, const std::string& where)
    : params_(params), constriction_(Constriction::from(params.cognitive, params.social, where)) {}

std::int64_t Pso::default_evaluations() const {
  return std::int64_t{params_.particles} * params_.generations;
}

OptimizerResult Pso::minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                              std::uint64_t seed) {
  check_search(cost, region, budget);
  const Deadline deadline(budget.seconds);
  const std::int64_t limit = budget.evaluations;
  const std::int64_t particles = std::min<std::int64_t>(params_.particles, limit);

  Swarm swarm(region, particles, params_.sigma, seed);
  Eigen::VectorXd costs(particles);
  BestSoFar best;
  for (std::uint32_t generation = 0; best.result().evaluations < limit; ++generation) {
    if (generation > 0) {
      if (deadline.passed()) break;
      swarm.move(constriction_, region, best.result().point, generation, seed);
    }
    const auto count = std::min(particles, limit - best.result().evaluations);
    cost.evaluate(swarm.position.leftCols(count), costs.head(count));
    swarm.remember(costs.head(count));
    best.update(swarm.position.leftCols(count), costs.head(count));
  }
  return best.result();
}

}  // namespace hypotrack
