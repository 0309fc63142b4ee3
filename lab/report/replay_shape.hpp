#pragma once

#include <nlohmann/json.hpp>

#include "hypotrack/export.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {

/// A model's mesh and skeleton as ReplayCollector::shapes() describes.
HYPOTRACK_API nlohmann::ordered_json replay_shape(const Model& model);

/// Pairs of landmarks to be joined by lines: each with the nearest one towards the root. Landmarks
/// of one bone form a chain from its origin outwards.
HYPOTRACK_API std::vector<std::pair<int, int>> skeleton_edges(const ModelData& data);

}  // namespace hypotrack
