#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <map>
#include <string>

#include "base/exported.hpp"
#include "model/import/reader/surfaces.hpp"
#include "model/import/wire.hpp"

// Conversion from assimp's data to mesh_wire's.
namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

using Bones = std::map<std::string, std::uint32_t, std::less<>>;  ///< name to index

aiMatrix4x4 global_transform(const aiNode* node);

/// Appends the bones of a mesh that are not known yet. Throws std::runtime_error if a known bone
/// has another bind pose.
void add_bones(const aiMesh& mesh, const aiMatrix4x4& file_from_mesh, Bones& known, Scene& out);

/// Sets the parent of every bone to its nearest ancestor that is a bone.
void find_parents(const aiScene& scene, const Bones& known, Scene& out);

/// Converts all meshes, placed by their nodes, and their bones. `uses` are those of the materials'
/// pictures. Of plain_gltf(), vertices are in the file's order and their colours are encoded.
void convert_meshes(const aiScene& scene, const std::vector<PictureUse>& uses, bool gltf,
                    Scene& out);

/// Converts materials and embedded textures as assimp has them, and returns the uses of pictures.
std::vector<PictureUse> convert_materials(const aiScene& scene, Scene& out);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
