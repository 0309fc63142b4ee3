#pragma once

#include <cstddef>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Keeps up to `bytes` of the pixels that this process reads from images from now on, for those who
/// read them again: runs of a study, which mostly share their recordings. They share the pixels.
void keep_read_images(std::size_t bytes);

}  // namespace internal
}  // namespace hypotrack
