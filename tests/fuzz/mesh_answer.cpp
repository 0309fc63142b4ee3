// Answers of the process that reads meshes, and what is made of them.

#include "model/import/steps.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {
namespace {

mesh_wire::Scene decoded(std::string_view bytes) {
  try {
    return mesh_wire::decode(bytes);
  } catch (const std::runtime_error& error) {
    throw DataError(error.what());
  }
}

}  // namespace

HYPOTRACK_FUZZ_TARGET(mesh_answer, "mesh") {
  const MeshFile file{scratch() / "mesh.glb", {}, decoded(bytes)};
  ImportedMesh imported;
  imported.bones = convert_bones(file);
  const Soup soup = join_parts(file);
  const Welded welded = fill_surface(file, soup, imported.mesh);
  fill_weights(soup, welded, imported.mesh);
  if (!soup.uvs.empty()) fill_uvs(soup, welded.triangles, imported.mesh);
  fill_appearance(file, imported.mesh);
  if (imported.mesh.texture.empty() && !soup.colors.empty())
    fill_vertex_colors(soup, welded.triangles, imported.mesh);
  require(imported.mesh.vertices.allFinite(), "vertices are finite");
  require(imported.mesh.bone_weights.allFinite(), "weights are finite");
  require(imported.mesh.triangles.maxCoeff() < imported.mesh.vertices.cols(), "corners are there");
}

}  // namespace hypotrack::fuzz
