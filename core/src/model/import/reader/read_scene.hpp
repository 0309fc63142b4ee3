#pragma once

#include <string>

#include "base/exported.hpp"
#include "model/import/wire.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads a mesh file with assimp. Files that assimp refuses set the result's `error`. Throws
/// std::runtime_error on files that assimp accepts but should not.
Scene read_scene(const std::string& file);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
