#pragma once

#include "hypotrack/observation.hpp"
#include "settings.hpp"

namespace hypotrack::skin {

/// Throws DataError unless a view has what tells foreground, and images that have their tile's size
/// and type.
void check(const Observation& observation, Foreground foreground);

}  // namespace hypotrack::skin
