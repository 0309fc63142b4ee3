#pragma once

#include <string>
#include <vector>

#include "base/exported.hpp"
#include "model/import/reader/gltf_file.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// Throws std::runtime_error if a file is of another version than 2, or requires an extension that
/// is not read; says how to export the file without it.
void check_gltf_support(const Json& root);

/// Returns notes on what a file has that is not read: extensions, animations, cameras, further
/// scenes, morph targets, points and lines, unknown attributes, keys and chunks.
std::vector<std::string> gltf_notes(const GltfFile& file);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
