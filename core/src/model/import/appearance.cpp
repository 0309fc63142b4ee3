#include <set>

#include "model/import/steps.hpp"
#include "model/import/texture.hpp"

namespace hypotrack::internal {

void fill_appearance(const MeshFile& file, const Soup& soup, const std::vector<int>& kept,
                     Mesh& mesh, std::vector<std::string>& /*notes*/) {
  std::set<std::string> textures;
  std::size_t most = 0;
  for (const mesh_wire::MeshPart& part : file.scene.meshes) {
    if (part.triangles.empty() || part.material >= file.scene.materials.size()) continue;
    const mesh_wire::Material& material = file.scene.materials[part.material];
    textures.insert(material.texture);
    if (part.triangles.size() <= most) continue;
    most = part.triangles.size();
    const Eigen::Vector3f color = material_color(file, part);
    if (color.allFinite()) mesh.color = color;
  }
  const bool own = file.options.texture.empty();
  if (own && (textures.empty() || *textures.rbegin() == "")) {
    mesh.uv.resize(2, 0);
    mesh.uv_triangles.resize(3, 0);
    return;
  }
  if (own && textures.size() > 1) return fill_materials(file, soup, kept, mesh);
  if (mesh.uv.cols() == 0) {
    file.fail("there is a texture, but not every part of the mesh has texture coordinates");
  }
  mesh.texture = own ? load_texture(file.scene, *textures.begin(), file.path)
                     : read_texture(file.options.texture, file.path.string());
}

}  // namespace hypotrack::internal
