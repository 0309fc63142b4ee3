// Out-of-line destructors anchor vtables in libhypotrack.so, so that dynamic casts work across
// plugin libraries.
#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/device_cost.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {

cuda::DeviceObjective::~DeviceObjective() = default;
void cuda::DeviceObjective::enqueue(const SceneLayout&, const BatchLayout&, Stream) {
  throw Error("this objective scores hypotheses on the GPU that are drawn before");
}
bool cuda::DeviceObjective::enqueue_search(const SceneLayout&, const BatchLayout&,
                                           const SwarmSearch&, Stream) {
  return false;
}
void cuda::DeviceObjective::enqueue_residuals(const SceneLayout&, const BatchLayout&,
                                              const DrawnBatch&, const ResidualLayout&, Stream) {
  throw Error("this objective has no residuals on the GPU");
}
void cuda::DeviceObjective::enqueue_slopes(const SceneLayout&, const DrawnBatch&,
                                           const SlopeLayout&, Stream) {
  throw Error("this objective has no slopes of residuals on the GPU");
}
cuda::DeviceCost::~DeviceCost() = default;
bool cuda::DeviceCost::enqueue_search(const SwarmSearch&) { return false; }
cuda::DescentCost::~DescentCost() = default;
ResidualDifferences::~ResidualDifferences() = default;
ResidualCost::~ResidualCost() = default;
NormalEquations ResidualCost::linearize(const Eigen::Ref<const Eigen::MatrixXd>&,
                                        const Eigen::Ref<const Eigen::VectorXd>&, double) {
  throw Error("this cost cannot be linearised");
}
std::vector<NormalEquations> ResidualCost::linearize_each(std::span<const Neighbourhood> points) {
  std::vector<NormalEquations> out;
  for (const Neighbourhood& at : points) out.push_back(linearize(at.points, at.steps, at.blur));
  return out;
}
CostFunction::~CostFunction() = default;
Optimizer::~Optimizer() = default;
std::vector<OptimizerResult> Optimizer::minimize_each(CostFunction& cost,
                                                      std::span<const SearchRegion> regions,
                                                      const Budget& budget, std::uint64_t seed) {
  const Deadline deadline(budget.seconds);
  std::vector<OptimizerResult> out;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    const double seconds = deadline.left() / static_cast<double>(regions.size() - k);
    out.push_back(minimize(cost, regions[k], {budget.evaluations, seconds, budget.usual_cost},
                           seed_of_part(seed, static_cast<std::uint32_t>(k))));
  }
  return out;
}

}  // namespace hypotrack
