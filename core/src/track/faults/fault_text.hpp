#pragma once

#include <string>

#include "base/exported.hpp"
#include "hypotrack/frame_fault.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns whether a frame with this fault has pictures that must not be searched.
bool spoils_pictures(FrameFault fault);

/// Describes a fault for the user: the finding, the tracker's reaction, and the remedy. `view` is
/// the view that has it, negative: all. Empty for FrameFault::none.
std::string describe(FrameFault fault, int view);

}  // namespace internal
}  // namespace hypotrack
