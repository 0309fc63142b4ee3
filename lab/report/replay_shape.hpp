#pragma once

#include <nlohmann/json.hpp>

#include "base/exported.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns a model's mesh and skeleton in the format of ReplayCollector::shapes().
nlohmann::ordered_json replay_shape(const Model& model);

/// Returns pairs of landmarks to join by lines, each with the nearest one towards the root.
/// Landmarks of one bone form a chain from its origin outwards.
std::vector<std::pair<int, int>> skeleton_edges(const ModelData& data);

}  // namespace internal
}  // namespace hypotrack
