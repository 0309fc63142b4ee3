#pragma once

#include "hypotrack/gpu/device_objective.hpp"

namespace hypotrack::test {

/// Enqueues a kernel that lets the next one start, takes its time and then writes 1.
void write_late(int* value, cuda::Stream stream);

/// Enqueues a kernel that may overlap the one before, waits for it and copies what that wrote. Its
/// code was made for a GPU that knows nothing of overlapping.
void copy(const int* from, int* to, cuda::Stream stream);

}  // namespace hypotrack::test
