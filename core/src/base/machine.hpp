#pragma once

#include <string>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the number of cores that this process may use, which a cluster may limit.
int core_count();

/// Returns the processor's name: `Intel(R) Xeon(R) Gold 6448Y`, or `unknown processor`.
std::string processor_name();

}  // namespace internal
}  // namespace hypotrack
