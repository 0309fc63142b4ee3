#pragma once

#include <set>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "model/import/reader/gltf_accessor.hpp"

// Steps of plain_gltf().
namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// Throws std::runtime_error if a file is of another version than 2, or requires an extension that
/// is not read; says how to export the file without it.
void check_gltf_support(const Json& root);

/// Returns notes on what a file has that is not read: extensions, animations, cameras, further
/// scenes, morph targets, points and lines, unknown attributes, keys and chunks.
std::vector<std::string> gltf_notes(const GltfFile& file);

/// What a file has that glTF 2.0 does not have.
struct GltfUnknown {
  std::set<std::string> keys;        ///< `nodes.odd`; those of the root without a dot
  std::set<std::string> extensions;  ///< of all objects but materials
};

/// Collects unknown keys and extensions of the objects that are read.
GltfUnknown unknown_in(const Json& root);

/// Moves the scale of inverse bind matrices to the positions that they take, and returns it.
/// Otherwise positions that are whole numbers have no known unit where the bones are not at their
/// bind pose.
double take_scale(GltfValues& matrices);

/// Gives every joint a name that no other node has: assimp finds bones by their names. Returns
/// notes on the joints that get another name.
std::vector<std::string> name_joints(Json& root);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
