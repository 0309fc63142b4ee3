#include "weighted_sum.hpp"

#include "hypotrack/gpu/state_objective.cuh"

namespace hypotrack::test {

std::unique_ptr<cuda::DeviceObjective> on_device(const WeightedSum& term) {
  return std::make_unique<cuda::StateObjective<WeightedSum>>(term);
}

}  // namespace hypotrack::test
