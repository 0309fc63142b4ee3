#pragma once

namespace hypotrack::detail {

/// Gives the calling thread a second stack for signal handlers, unless it has one: none can run on
/// a stack that is full.
void ensure_signal_stack();

}  // namespace hypotrack::detail
