#pragma once

#include <memory>

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::test {

/// A term that tells all numbers of a state apart.
struct WeightedSum {
  double factor;

  HYPOTRACK_PIXEL double cost(const double* state, int dimension) const {
    double sum = 0;
    for (int i = 0; i < dimension; ++i) sum += factor * (i + 1) * state[i];
    return sum;
  }
};

std::unique_ptr<cuda::DeviceObjective> on_device(const WeightedSum& term);

}  // namespace hypotrack::test
