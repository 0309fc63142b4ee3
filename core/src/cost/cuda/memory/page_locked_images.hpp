#pragma once

#include <cstddef>

#include "base/exported.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Makes OpenCV allocate all later images of 64 KiB or more in page-locked memory, which a GPU
/// reads directly. It takes up to `most` bytes and what fills their huge
/// pages, reuses them and never releases them. Makes `device`
/// the GPU of this thread. Does nothing if the device is unusable; one call is enough. Forked
/// children must exec before they touch such an image.
void page_lock_images(int device, std::size_t most = std::size_t{1} << 30);

}  // namespace internal
}  // namespace hypotrack::cuda
