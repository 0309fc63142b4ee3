#pragma once

#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/search_record.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Draws the state of a record into the tiles of its observation and adds the depths, and the maps
/// of those terms that have some. Prepares these terms with the observation.
void draw_maps(const Scene& scene, const std::vector<ObjectiveTerm>& terms, SearchRecord& record);

}  // namespace internal
}  // namespace hypotrack
