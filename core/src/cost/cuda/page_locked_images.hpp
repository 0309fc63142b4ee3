#pragma once

#include "hypotrack/export.hpp"

namespace hypotrack::cuda {

/// From now on, images of 64 KiB or more that anything in this process makes lie in page-locked
/// memory, which a GPU reads from where it is: up to 1 GiB, kept and reused, never given back.
/// Makes `device` the GPU of this thread. Does nothing where it cannot be used; once is enough.
/// Forked children must exec before they touch such an image.
HYPOTRACK_API void page_lock_images(int device);

}  // namespace hypotrack::cuda
