#pragma once

namespace hypotrack::cuda {

/// Returns true if this library was built for the architecture of this thread's GPU.
bool has_code_for_current_device();

}  // namespace hypotrack::cuda
