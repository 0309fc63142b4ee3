#pragma once

#include <string>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Returns the number of cores that this process may use, which a cluster may limit.
HYPOTRACK_API int core_count();

/// Returns the processor's name: `Intel(R) Xeon(R) Gold 6448Y`, or `unknown processor`.
HYPOTRACK_API std::string processor_name();

}  // namespace hypotrack
