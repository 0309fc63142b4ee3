#pragma once

#include <string>

#include "model/import/wire.hpp"

namespace hypotrack::mesh_wire {

/// Reads a mesh file with assimp. Files that assimp refuses set the result's `error`. Throws
/// std::runtime_error on files that assimp accepts but should not.
Scene read_scene(const std::string& file);

}  // namespace hypotrack::mesh_wire
