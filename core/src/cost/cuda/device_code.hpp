#pragma once

#include "base/exported.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns true if this library was built for the architecture of this thread's GPU.
bool has_code_for_current_device();

}  // namespace internal
}  // namespace hypotrack::cuda
