#pragma once

#include <cstdint>

#include "hypotrack/gpu/device_objective.hpp"

namespace hypotrack::test {

/// Enqueues the costs of `count` points in device memory, with the target there, too. Lets the
/// kernel behind it start, and starts itself, as early as the device can do that. Without a target
/// the kernel fails.
void enqueue_quadratic(const double* target, int dimension, const double* points,
                       std::int64_t count, double* costs, cuda::Stream stream);

}  // namespace hypotrack::test
