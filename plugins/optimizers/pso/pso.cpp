#include "pso.hpp"

#include <algorithm>
#include <limits>

#include "hypotrack/search.hpp"
#include "particle.hpp"

namespace hypotrack {
namespace {

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
        position(d, p) = initial_position(
            region.start[d], sigma * region.spread[d], {region.lower[d], region.upper[d]}, seed,
            static_cast<std::uint32_t>(d), static_cast<std::uint32_t>(p));
      }
    }
    own_best = position;
  }

  void move(const Constriction& constriction, const SearchRegion& region,
            const Eigen::VectorXd& swarm_best, std::uint32_t generation, std::uint64_t seed) {
    for (Eigen::Index p = 0; p < position.cols(); ++p) {
      for (Eigen::Index d = 0; d < position.rows(); ++d) {
        const auto r = uniform4(seed, {static_cast<std::uint32_t>(d), static_cast<std::uint32_t>(p),
                                       generation, kMoveStream});
        const Motion motion = moved({position(d, p), velocity(d, p)}, constriction, own_best(d, p),
                                    swarm_best[d], r[0], r[1], {region.lower[d], region.upper[d]});
        position(d, p) = motion.position;
        velocity(d, p) = motion.velocity;
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
