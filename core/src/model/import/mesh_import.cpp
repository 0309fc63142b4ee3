#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "model/import/format.hpp"
#include "model/import/imported_meshes.hpp"
#include "model/import/process.hpp"
#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

/// Returns how to convert a DAE file; nothing of other files.
std::string conversion(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".dae") return {};
  const std::string name = file.stem().string();
  return fmt::format(
      "; convert the DAE file, for example: blender -b --python-expr \"import bpy; "
      "bpy.ops.wm.read_homefile(use_empty=True); bpy.ops.wm.collada_import(filepath='{0}.dae'); "
      "bpy.ops.export_scene.gltf(filepath='{0}.glb')\" (Blender before 5.0)",
      name);
}

void read_scene(MeshFile& file) {
  std::vector<std::string> notes = check_mesh_format(file.path);
  const MeshReader reader = default_mesh_reader(file.path);
  try {
    file.scene = mesh_wire::decode(run_mesh_reader(reader, file.path));
  } catch (const DataError& error) {
    throw DataError(error.what() + conversion(file.path));
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const Error*>(&error)) throw;
    file.fail(fmt::format("the mesh could not be read: {}", error.what()));
  }
  if (!file.scene.error.empty())
    file.fail("the mesh could not be read: " + file.scene.error + conversion(file.path));
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
  return kept_mesh(path, options, [&] {
    MeshFile file{path, options, {}};
    read_scene(file);
    return convert_mesh(file);
  });
}

}  // namespace hypotrack
