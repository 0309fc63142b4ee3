#pragma once

#include <vector>

#include "base/exported.hpp"
#include "model/import/reader/gltf_accessor.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// Moves the scale of inverse bind matrices to the positions that they take, and returns it.
/// Otherwise positions that are whole numbers have no known unit where the bones are not at their
/// bind pose.
double take_scale(GltfValues& matrices);

/// Gives every joint a name that no other node has: assimp finds bones by their names. Returns
/// notes on the joints that get another name.
std::vector<std::string> name_joints(Json& root);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
