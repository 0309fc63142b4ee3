#include "icp_pso.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "hypotrack/plugin/search.hpp"
#include "swarm.hpp"

namespace hypotrack {
namespace {

struct Particle {
  Eigen::VectorXd position;
  Eigen::VectorXd velocity;
  Eigen::VectorXd own_best;
  double own_best_cost = std::numeric_limits<double>::infinity();

  explicit Particle(const Eigen::VectorXd& at)
      : position(at), velocity(Eigen::VectorXd::Zero(at.size())), own_best(at) {}

  void move(const Constriction& constriction, const SearchRegion& region,
            const Eigen::VectorXd& swarm_best, std::uint64_t seed, std::uint32_t number,
            std::uint32_t generation) {
    for (Eigen::Index d = 0; d < position.size(); ++d) {
      const auto r =
          uniform4(seed, {static_cast<std::uint32_t>(d), number, generation, kMoveStream});
      const Motion motion = moved({position[d], velocity[d]}, constriction, own_best[d],
                                  swarm_best[d], r[0], r[1], {region.lower[d], region.upper[d]});
      position[d] = motion.position;
      velocity[d] = motion.velocity;
    }
  }

  void refine(const OptimizerResult& found) {
    position = found.point;
    if (found.cost < own_best_cost) {
      own_best_cost = found.cost;
      own_best = found.point;
    }
  }
};

/// Adds the result of a search to that of all, the earlier of equal ones being better.
void add(const OptimizerResult& found, OptimizerResult& best) {
  const std::int64_t evaluations = best.evaluations + found.evaluations;
  if (best.evaluations == 0 || found.cost < best.cost) best = found;
  best.evaluations = evaluations;
}

}  // namespace

IcpPso::IcpPso(const IcpPsoParams& params, std::unique_ptr<Optimizer> optimizer,
               const std::string& where)
    : params_(params),
      constriction_(make_constriction(params.cognitive, params.social, where)),
      optimizer_(std::move(optimizer)) {}

std::int64_t IcpPso::default_evaluations() const {
  constexpr std::int64_t kWithAnalyticJacobians = 9;
  const std::int64_t each =
      params_.local_evaluations > 0 ? params_.local_evaluations : kWithAnalyticJacobians;
  return each * params_.particles * params_.generations;
}

std::int64_t IcpPso::local_evaluations(CostFunction& cost) const {
  if (params_.local_evaluations > 0) return params_.local_evaluations;
  const ResidualCost* residuals = cost.residuals();
  std::int64_t jacobian = 1;
  if (residuals) {
    jacobian = residuals->can_linearize() ? residuals->linearize_price(cost.dimension())
                                          : cost.dimension();
  }
  return 1 + 2 * (jacobian + 3);
}

OptimizerResult IcpPso::minimize(CostFunction& cost, const SearchRegion& region,
                                 const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  const Deadline deadline(budget.seconds);
  const std::int64_t each = std::min(local_evaluations(cost), budget.evaluations);
  const auto count = std::min<std::int64_t>(params_.particles, budget.evaluations / each);
  const Eigen::MatrixXd points = StartPoints(region, params_.start, seed).points(0, count);
  std::vector<Particle> swarm;
  for (const auto& point : points.colwise()) swarm.emplace_back(point);

  OptimizerResult best;
  for (std::uint32_t generation = 0; budget.evaluations - best.evaluations >= each; ++generation) {
    if (generation > 0 && deadline.passed()) break;
    const auto active = std::min(count, (budget.evaluations - best.evaluations) / each);
    std::vector<SearchRegion> regions(static_cast<std::size_t>(active), region);
    for (std::size_t p = 0; p < regions.size(); ++p) {
      if (generation > 0) {
        swarm[p].move(constriction_, region, best.point, seed, static_cast<std::uint32_t>(p),
                      generation);
      }
      regions[p].start = swarm[p].position;
    }
    const std::vector<OptimizerResult> found = optimizer_->minimize_each(
        cost, regions, {each, deadline.left(), budget.usual_cost}, seed_of_part(seed, generation));
    for (std::size_t p = 0; p < found.size(); ++p) {
      swarm[p].refine(found[p]);
      add(found[p], best);
    }
  }
  return best;
}

}  // namespace hypotrack
