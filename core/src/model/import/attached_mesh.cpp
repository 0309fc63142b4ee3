#include <fmt/format.h>

#include "config/read_value.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "model/import/steps.hpp"

namespace hypotrack {
namespace {

/// Returns a mesh in memory as the reader of files returns one.
mesh_wire::MeshPart part_of(const MeshArrays& mesh, const std::string& where) {
  if (mesh.colors.cols() != 0 && mesh.colors.cols() != mesh.vertices.cols())
    throw DataError(fmt::format("{}: it has {} colours for {} vertices; expected one for each",
                                where, mesh.colors.cols(), mesh.vertices.cols()));
  mesh_wire::MeshPart part;
  part.name = "mesh";
  for (const auto& v : mesh.vertices.colwise()) part.positions.push_back({v[0], v[1], v[2]});
  for (const auto& c : mesh.colors.colwise()) part.colors.push_back({c[0], c[1], c[2]});
  for (const auto& t : mesh.triangles.colwise()) {
    if (t.minCoeff() < 0)
      throw DataError(
          fmt::format("{}: a triangle has the vertex {}; expected 0 or more", where, t.minCoeff()));
    part.triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                              static_cast<std::uint32_t>(t[2])});
  }
  return part;
}

}  // namespace

ImportedMesh import_mesh(const PluginContext& context, const std::filesystem::path& file,
                         const MeshImportOptions& options) {
  const std::string& name = file.native();
  if (!name.starts_with(detail::kAttached)) return import_mesh(file, options);
  const MeshArrays& mesh = context.attached_mesh(name.substr(detail::kAttached.size()));
  MeshFile made{name, options, {}};
  made.scene.meshes.push_back(part_of(mesh, name));
  return convert_mesh(made);
}

}  // namespace hypotrack
