#pragma once

#include <string>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// The cores that this process may use, which a cluster may have limited.
HYPOTRACK_API int core_count();

/// `Intel(R) Xeon(R) Gold 6448Y`, or `unknown processor` where the system does not say.
HYPOTRACK_API std::string processor_name();

}  // namespace hypotrack
