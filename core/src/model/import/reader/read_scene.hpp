#pragma once

#include <string>

#include "model/import/wire.hpp"

namespace hypotrack::mesh_wire {

/// Everything in a mesh file, by assimp. What assimp refuses is in the answer's `error`; throws
/// std::runtime_error on what assimp accepts and should not.
Scene read_scene(const std::string& file);

}  // namespace hypotrack::mesh_wire
