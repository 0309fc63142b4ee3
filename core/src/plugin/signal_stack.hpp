#pragma once

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Gives the calling thread a second stack for signal handlers, unless it has one: none can run on
/// a stack that is full.
void ensure_signal_stack();

}  // namespace internal
}  // namespace hypotrack::detail
