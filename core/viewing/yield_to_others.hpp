#pragma once

namespace hypotrack {

/// Lowers the priority of the calling thread, and of those it will start, so that drawing takes
/// processor time only where the tracker leaves some.
void yield_to_others();

}  // namespace hypotrack
