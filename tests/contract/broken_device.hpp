#pragma once

#include <memory>

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack {

/// The squared length of the state.
struct SquaredLength {
  HYPOTRACK_PIXEL double cost(const double* state, int dimension) const {
    double sum = 0;
    for (int i = 0; i < dimension; ++i) sum += state[i] * state[i];
    return sum;
  }
};

/// Faults of the objective on the device.
struct DeviceFaults {
  bool another_cost = false;
  bool never_repeats = false;
  bool accepts_everything = false;
};

std::unique_ptr<cuda::DeviceObjective> on_device(const DeviceFaults& faults);

}  // namespace hypotrack
