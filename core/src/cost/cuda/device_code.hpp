#pragma once

namespace hypotrack::cuda {

/// Whether the architectures that this library was built for include the GPU of this thread.
bool has_code_for_current_device();

}  // namespace hypotrack::cuda
