#pragma once

#include <cstdint>
#include <string>

namespace hypotrack::mesh_wire {

/// Counts the triangles of all meshes that a glTF or GLB file declares. Throws std::exception on
/// other files. Part of the reader process.
std::uint64_t count_gltf_triangles(const std::string& file);

}  // namespace hypotrack::mesh_wire
