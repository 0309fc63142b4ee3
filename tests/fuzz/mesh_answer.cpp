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
  const ImportedMesh imported = convert_mesh(file);
  require(imported.mesh.vertices.allFinite(), "vertices are finite");
  require(imported.mesh.bone_weights.allFinite(), "weights are finite");
  require(imported.mesh.triangles.maxCoeff() < imported.mesh.vertices.cols(), "corners are there");
}

}  // namespace hypotrack::fuzz
