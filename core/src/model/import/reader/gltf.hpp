#pragma once

#include <set>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "model/import/reader/gltf_accessor.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// A GLB file that assimp reads right, and what was left out of it.
struct PlainGltf {
  std::string glb;
  std::vector<std::string> notes;
};

/// Rewrites a glTF or GLB file as one GLB file without external buffers. Positions, texture
/// coordinates, colours and weights become floats, because assimp 5.2.5 takes the bits of other
/// numbers for floats. Every skin gets bind matrices, without which it crashes, and every joint a
/// name of its own. Throws std::exception on files that are damaged or require what is not read.
/// Part of the reader process.
PlainGltf plain_gltf(const std::string& file);

// --- Steps of plain_gltf()

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
