#pragma once

#include "base/exported.hpp"

namespace hypotrack::gl {
inline namespace HYPOTRACK_EXPORTED internal {

/// Throws DeviceError unless as many threads can be started as Mesa's software rasteriser starts:
/// it waits for ever for threads that do not start.
void expect_driver_threads();

}  // namespace internal
}  // namespace hypotrack::gl
