#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "hypotrack/error.hpp"
#include "hypotrack/mesh_io.hpp"
#include "model/import/format.hpp"
#include "model/import/process.hpp"
#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

void read_scene(MeshFile& file) {
  std::vector<std::string> notes = check_mesh_format(file.path);
  try {
    file.scene = mesh_wire::decode(run_mesh_reader(default_mesh_reader(file.path), file.path));
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const Error*>(&error)) throw;
    file.fail(fmt::format("the mesh could not be read: {}", error.what()));
  }
  if (!file.scene.error.empty()) file.fail("the mesh could not be read: " + file.scene.error);
  file.scene.notes.insert(file.scene.notes.begin(), notes.begin(), notes.end());
}

}  // namespace

void MeshFile::fail(const std::string& what) const { throw DataError(path.string() + ": " + what); }

ImportedMesh convert_mesh(const MeshFile& file) {
  ImportedMesh imported;
  imported.notes = file.scene.notes;
  imported.bones = convert_bones(file);
  const Soup soup = join_parts(file);
  const Welded welded = fill_surface(file, soup, imported.mesh);
  fill_weights(soup, welded, imported.mesh);
  fill_appearance(file, soup, welded.triangles, imported.mesh, imported.notes);
  for (std::string& note : imported.notes) note = fmt::format("{}: {}", file.path.string(), note);
  return imported;
}

}  // namespace hypotrack::internal

namespace hypotrack {

ImportedMesh import_mesh(const std::filesystem::path& path, const MeshImportOptions& options) {
  if (!(options.scale > 0) || !std::isfinite(options.scale)) {
    throw DataError(fmt::format("{}: the scale of a mesh must be positive, not {}", path.string(),
                                options.scale));
  }
  MeshFile file{path, options, {}};
  read_scene(file);
  return convert_mesh(file);
}

}  // namespace hypotrack
