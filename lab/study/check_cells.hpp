#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "hypotrack/export.hpp"
#include "lab/study/launch.hpp"
#include "lab/study/plan.hpp"

namespace hypotrack::study {

/// Opens the scene of every given cell as a run would, up to its first frame, each in a process of
/// its own. `again` is asked now and then, and stops the work by returning false. Throws
/// ConfigError with what is wrong, and the line of the study that it comes from.
HYPOTRACK_API void check_cells(const Plan& plan, const std::vector<std::size_t>& cells,
                               const Launch& launch, const std::function<bool()>& again);

}  // namespace hypotrack::study
