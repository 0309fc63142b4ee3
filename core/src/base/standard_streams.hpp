#pragma once

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Opens /dev/null in place of standard input, output and error where one is closed. The next files
/// to be opened would get their descriptors, and what is printed would land in them. The first call
/// in main() of every program. Ends the program if /dev/null cannot be opened.
void open_standard_streams();

}  // namespace internal
}  // namespace hypotrack
