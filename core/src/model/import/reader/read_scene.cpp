#include "model/import/reader/read_scene.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "model/import/reader/convert.hpp"
#include "model/import/reader/gltf.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

/// Knows regular files only. A pipe that a mesh names as its materials or its data would be waited
/// for.
class RegularFiles : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* file) const override {
    std::error_code error;
    return std::filesystem::is_regular_file(file, error);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return Exists(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
  }
};

/// Keeps only the importers of one file name extension. Otherwise assimp inspects a file that the
/// right importer refuses and may pass it to one that crashes on it.
void keep_importers(Assimp::Importer& importer, const std::string& extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* about = importer.GetImporterInfo(i);
    const std::string known = about ? std::string(" ") + about->mFileExtensions + " " : "";
    const bool old_gltf = about && std::string_view(about->mName).starts_with("glTF Importer");
    if (known.find(" " + extension + " ") == std::string::npos || old_gltf) {
      importer.UnregisterLoader(importer.GetImporter(i));
    }
  }
}

/// Throws if the glTF importer skipped triangles, which it does if their vertices do not exist.
void check_triangle_count(const aiScene& scene, const std::string& file) {
  std::uint64_t found = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) found += mesh.mFaces[k].mNumIndices == 3 ? 1 : 0;
  }
  const std::uint64_t expected = count_gltf_triangles(file);
  if (found < expected) {
    throw std::runtime_error(std::to_string(expected - found) + " of its " +
                             std::to_string(expected) +
                             " triangles name vertices that are not there");
  }
}

std::string extension_of(const std::string& file) {
  std::string extension = file.substr(file.rfind('.') + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

Scene read_scene(const std::string& file) {
  const std::string extension = extension_of(file);
  Assimp::Importer importer;
  importer.SetIOHandler(new RegularFiles);  // which it deletes
  keep_importers(importer, extension);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_REMOVE_EMPTY_BONES, false);
  const aiScene* scene = importer.ReadFile(file, aiProcess_Triangulate);
  Scene out;
  if (!scene || !scene->mRootNode) {
    out.error = importer.GetErrorString();
    if (out.error.empty()) out.error = "the file holds no scene";
    return out;
  }
  if (extension.starts_with("gl")) check_triangle_count(*scene, file);
  convert_meshes(*scene, out);
  convert_materials(*scene, out);
  return out;
}

}  // namespace hypotrack::mesh_wire::internal
