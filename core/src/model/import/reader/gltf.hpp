#pragma once

#include <cstdint>
#include <string>

#include "base/exported.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// Counts the triangles of all meshes that a glTF or GLB file declares. Throws std::exception on
/// other files. Part of the reader process.
std::uint64_t count_gltf_triangles(const std::string& file);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
