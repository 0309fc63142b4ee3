#pragma once

#include <string>
#include <vector>

#include "base/exported.hpp"
#include "model/import/reader/gltf_file.hpp"
#include "model/import/wire.hpp"

struct aiScene;

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// The use of a picture by a material.
struct PictureUse {
  unsigned set = 0;       ///< of the mesh's sets of texture coordinates
  bool or_first = false;  ///< a mesh without that set has its first one used
};

/// Adds a note on what a material has that is not drawn, if that is anything.
inline void add_note(const Material& material, const std::vector<std::string>& left_out,
                     Scene& out) {
  if (left_out.empty()) return;
  std::string words;
  for (const std::string& word : left_out) words += (words.empty() ? "" : ", ") + word;
  out.notes.push_back("material '" + material.name + "' is not drawn as the file says: " + words);
}

/// Sets the colours, pictures, factors, wraps and moves of an OBJ file's materials by its MTL
/// files, of which assimp reads only a part. Adds notes on missing files, undefined materials and
/// what is not drawn.
void convert_mtl_materials(const std::string& obj, Scene& out);

/// Sets the colours, pictures, factors and wraps of materials, whose names are their numbers in a
/// glTF or GLB file, and adds a note per material on what is not drawn. Returns the use of their
/// pictures. Throws std::exception on pictures that cannot be read.
std::vector<PictureUse> convert_gltf_materials(GltfFile& file, Scene& out);

/// Sets what assimp leaves out of a COLLADA file's materials, adds notes on elements that are not
/// read and returns the use of pictures. Throws std::exception on skins and wrong units.
std::vector<PictureUse> convert_dae(const std::string& file, const aiScene& scene, Scene& out);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
