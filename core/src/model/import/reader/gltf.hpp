#pragma once

#include <cstdint>
#include <string>

namespace hypotrack::mesh_wire {

/// How many triangles a glTF or GLB file says that it has, in all its meshes. Throws std::exception
/// on a file that is none. Part of the reader process.
std::uint64_t count_gltf_triangles(const std::string& file);

}  // namespace hypotrack::mesh_wire
