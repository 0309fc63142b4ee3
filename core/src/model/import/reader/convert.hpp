#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <map>
#include <string>

#include "model/import/wire.hpp"

// From assimp's data to ours.
namespace hypotrack::mesh_wire {

using Bones = std::map<std::string, std::uint32_t, std::less<>>;  ///< name to index

aiMatrix4x4 global_transform(const aiNode* node);

/// Appends the bones of a mesh that are not known yet. Throws std::runtime_error if one stands
/// elsewhere than for a mesh before.
void add_bones(const aiMesh& mesh, const aiMatrix4x4& file_from_mesh, Bones& known, Scene& out);

/// Gives every bone its nearest ancestor that is a bone.
void find_parents(const aiScene& scene, const Bones& known, Scene& out);

/// All meshes where their nodes place them, and their bones.
void convert_meshes(const aiScene& scene, Scene& out);

/// Materials and embedded textures.
void convert_materials(const aiScene& scene, Scene& out);

}  // namespace hypotrack::mesh_wire
