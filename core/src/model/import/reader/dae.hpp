#pragma once

#include <assimp/scene.h>

#include <string>
#include <vector>

#include "base/exported.hpp"
#include "model/import/reader/surfaces.hpp"
#include "model/import/wire.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// Sets what assimp leaves out of a COLLADA file's materials, adds notes on elements that are not
/// read and returns the use of pictures. Throws std::exception on skins and wrong units.
std::vector<PictureUse> convert_dae(const std::string& file, const aiScene& scene, Scene& out);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
