// hypotrack_mesh_reader FILE SECONDS: reads a mesh file with assimp and writes its content to
// standard output (wire.hpp). It is a separate program because assimp may crash or hang on a
// damaged file, and a forked process of a program with threads may not allocate.

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <charconv>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/standard_streams.hpp"
#include "model/import/reader/convert.hpp"
#include "model/import/reader/gltf.hpp"
#include "model/import/reader/gltf_file.hpp"
#include "model/import/wire.hpp"

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

std::string extension_of(const std::string& file) {
  std::string extension = file.substr(file.rfind('.') + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// Reads a mesh file with assimp. Files that assimp refuses set the result's `error`. Throws
/// std::runtime_error on files that assimp accepts but should not.
Scene read_scene(const std::string& file) {
  const std::string extension = extension_of(file);
  Assimp::Importer importer;
  importer.SetIOHandler(new RegularFiles);  // which it deletes
  keep_importers(importer, extension);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_REMOVE_EMPTY_BONES, false);
  // RViz, MoveIt and their users' files have DAE coordinates as they are, whatever way is up.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  Scene out;
  const bool gltf = extension == "gltf" || extension == "glb";
  const PlainGltf plain = gltf ? plain_gltf(file) : PlainGltf{};
  out.notes = plain.notes;
  const aiScene* scene = gltf ? importer.ReadFileFromMemory(plain.glb.data(), plain.glb.size(),
                                                            aiProcess_Triangulate, "glb")
                              : importer.ReadFile(file, aiProcess_Triangulate);
  if (!scene || !scene->mRootNode) {
    out.error = importer.GetErrorString();
    if (out.error.empty()) out.error = "the file holds no scene";
    return out;
  }
  std::vector<PictureUse> uses = convert_materials(*scene, out);
  if (gltf) {
    GltfFile whole(file);
    uses = convert_gltf_materials(whole, out);
  }
  if (extension == "obj") convert_mtl_materials(file, out);
  if (extension == "dae") uses = convert_dae(file, *scene, out);
  out.linear_colors = gltf ? 1 : 0;
  convert_meshes(*scene, uses, gltf, out);
  return out;
}

constexpr rlim_t kMemoryLimit = rlim_t{4} << 30;

void limit_resources(rlim_t seconds) {
  const rlimit memory{kMemoryLimit, kMemoryLimit};
  setrlimit(RLIMIT_AS, &memory);
  const rlimit cpu{seconds, seconds};
  setrlimit(RLIMIT_CPU, &cpu);
  const rlimit core{0, 0};
  setrlimit(RLIMIT_CORE, &core);
}

bool write_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

}  // namespace hypotrack::mesh_wire::internal

int main(int argc, char** argv) {
  namespace wire = hypotrack::mesh_wire;
  hypotrack::open_standard_streams();
  unsigned seconds = 0;
  if (argc != 3 ||
      std::from_chars(argv[2], argv[2] + std::string_view(argv[2]).size(), seconds).ec !=
          std::errc()) {
    return 2;
  }
  wire::limit_resources(seconds);
  wire::Scene scene;
  try {
    scene = wire::read_scene(argv[1]);
  } catch (const std::exception& error) {
    scene = {};
    scene.error = error.what();
  }
  return wire::write_all(wire::encode(scene)) ? 0 : 1;
}
