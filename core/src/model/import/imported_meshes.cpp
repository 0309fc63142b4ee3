#include "model/import/imported_meshes.hpp"

#include "base/kept_results.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kMostMeshes = 16;  // a scene has one or two

using Key = std::tuple<FileVersion, FileVersion, double>;

KeptResults<Key, ImportedMesh>& meshes() {
  static KeptResults<Key, ImportedMesh> kept([](const ImportedMesh&) { return std::size_t{1}; });
  return kept;
}

}  // namespace

void keep_imported_meshes() { meshes().keep(kMostMeshes); }

ImportedMesh kept_mesh(const std::filesystem::path& file, const MeshImportOptions& options,
                       const std::function<ImportedMesh()>& import) {
  if (!meshes().keeps()) return import();
  return meshes().get({version_of(file), version_of(options.texture), options.scale}, import);
}

}  // namespace hypotrack::internal
