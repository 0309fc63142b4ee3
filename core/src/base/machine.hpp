#pragma once

#include <cstddef>
#include <string>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the number of cores that this process may use, which a cluster may limit.
int core_count();

/// Returns the bytes of memory that this process may use, which a container may limit.
std::size_t memory_size();

/// Returns the processor's name: `Intel(R) Xeon(R) Gold 6448Y`, or `unknown processor`.
std::string processor_name();

/// Claims something of this machine, by a name of up to 80 characters, for as long as this process
/// lives. Returns false if another hypotrack has claimed it; true if that cannot be told.
bool claim(const std::string& name);

}  // namespace internal
}  // namespace hypotrack
