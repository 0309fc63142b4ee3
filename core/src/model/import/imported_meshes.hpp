#pragma once

#include <filesystem>
#include <functional>

#include "base/exported.hpp"
#include "hypotrack/api/mesh_io.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Keeps meshes that this process imports from now on, for those who import them again: runs of a
/// study, which mostly share theirs. They must leave the files that a mesh names as they are.
void keep_imported_meshes();

/// Returns a kept mesh, or makes it with `import`, while others who want it wait. A mesh or given
/// texture that changed is imported anew. Just makes it unless meshes are kept. Throws what
/// `import` throws.
ImportedMesh kept_mesh(const std::filesystem::path& file, const MeshImportOptions& options,
                       const std::function<ImportedMesh()>& import);

}  // namespace internal
}  // namespace hypotrack
