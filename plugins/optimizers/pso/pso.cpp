#include "pso.hpp"

#include <algorithm>
#include <limits>

#include "hypotrack/plugin/particle.hpp"
#include "hypotrack/plugin/search.hpp"
#include "swarm.hpp"

namespace hypotrack {
namespace {

/// Parameters of the particles' motion.
struct SwarmSettings {
  Constriction constriction;
  LimbReset reset;
  Limbs limbs;
  double sigma;
};

/// Positions, velocities and best positions of the particles, DxN.
struct Swarm {
  Eigen::MatrixXd position;
  Eigen::MatrixXd velocity;
  Eigen::MatrixXd own_best;
  Eigen::VectorXd own_best_cost;

  Swarm(const SearchRegion& region, Eigen::Index particles, const StartDistribution& starts,
        std::uint64_t seed)
      : position(StartPoints(region, starts, seed).points(0, particles)),
        velocity(Eigen::MatrixXd::Zero(region.start.size(), particles)),
        own_best(position),
        own_best_cost(
            Eigen::VectorXd::Constant(particles, std::numeric_limits<double>::infinity())) {}

  void move(const SwarmSettings& how, const SearchRegion& region, const Eigen::VectorXd& swarm_best,
            std::uint32_t generation, std::uint64_t seed) {
    const bool due = how.reset.due(generation) && how.limbs.count > 0;
    for (Eigen::Index p = 0; p < position.cols(); ++p) {
      const auto particle = static_cast<std::uint32_t>(p);
      const int anew = due ? how.reset.limb(seed, particle, generation, how.limbs.count) : -1;
      for (Eigen::Index d = 0; d < position.rows(); ++d) {
        const RandomIndex index{static_cast<std::uint32_t>(d), particle, generation, kMoveStream};
        const Interval bounds{region.lower[d], region.upper[d]};
        const bool of_limb =
            anew >= 0 && how.limbs.of_dimension[static_cast<std::size_t>(d)] == anew;
        const auto r = uniform4(seed, index);
        const Motion motion =
            of_limb ? placed_anew(swarm_best[d],
                                  anew_offset(how.sigma * region.spread[d], seed, index), bounds)
                    : moved({position(d, p), velocity(d, p)}, how.constriction, own_best(d, p),
                            swarm_best[d], r[0], r[1], bounds);
        position(d, p) = motion.position;
        velocity(d, p) = motion.velocity;
      }
    }
  }

  /// Updates the particles' best positions with the costs of the first particles.
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
    : params_(params), constriction_(make_constriction(params.cognitive, params.social, where)) {}

std::int64_t Pso::default_evaluations() const {
  return std::int64_t{params_.particles} * params_.generations;
}

OptimizerResult Pso::minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                              std::uint64_t seed) {
  check_search(cost, region, budget);
  const Deadline deadline(budget.seconds);
  const std::int64_t limit = budget.evaluations;
  const std::int64_t particles = std::min<std::int64_t>(params_.particles, limit);

  const SwarmSettings how{constriction_, params_.reset, Limbs(region), params_.start.sigma};
  Swarm swarm(region, particles, params_.start, seed);
  Eigen::VectorXd costs(particles);
  BestSoFar best;
  for (std::uint32_t generation = 0; best.result().evaluations < limit; ++generation) {
    if (generation > 0) {
      if (deadline.passed()) break;
      swarm.move(how, region, best.result().point, generation, seed);
    }
    const auto count = std::min(particles, limit - best.result().evaluations);
    cost.evaluate(swarm.position.leftCols(count), costs.head(count));
    swarm.remember(costs.head(count));
    best.update(swarm.position.leftCols(count), costs.head(count));
  }
  return best.result();
}

}  // namespace hypotrack
