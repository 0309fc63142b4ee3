#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <vector>

#include "base/exported.hpp"
#include "lab/study/launch.hpp"
#include "lab/study/plan.hpp"
#include "run/crew/crew.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// Checks the scenes of the given cells: a crew opens each as a run would, up to its first frame.
/// Returns the number of the GPU that each takes, for those that take one. Calls `again` now and
/// then; it stops the work by returning false. Throws ConfigError with all problems and the lines
/// of the study that they come from.
std::map<std::size_t, int> check_cells(const Plan& plan, const std::vector<std::size_t>& cells,
                                       const Launch& launch, Crew& crew,
                                       const std::function<bool()>& again);

}  // namespace internal
}  // namespace hypotrack::study
