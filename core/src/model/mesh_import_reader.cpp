// hypotrack_mesh_reader FILE SECONDS: reads a mesh file with assimp and writes what it holds to the
// standard output (mesh_import_wire.hpp). It is a program of its own because assimp may crash on or
// never return from a damaged file, and because a fork of a program with threads may not allocate.

#include <assimp/BaseImporter.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <charconv>
#include <cmath>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "model/mesh_import_gltf.hpp"
#include "model/mesh_import_wire.hpp"

namespace hypotrack::mesh_wire {
namespace {

constexpr rlim_t kMemoryLimit = rlim_t{4} << 30;

void limit_resources(rlim_t seconds) {
  const rlimit memory{kMemoryLimit, kMemoryLimit};
  setrlimit(RLIMIT_AS, &memory);
  const rlimit cpu{seconds, seconds};
  setrlimit(RLIMIT_CPU, &cpu);
  const rlimit core{0, 0};
  setrlimit(RLIMIT_CORE, &core);
}

/// Leaves only the importers of one file name extension: assimp otherwise looks into a file that
/// the right importer refuses and may hand it to one that does not survive it.
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

using Bones = std::map<std::string, std::uint32_t, std::less<>>;

aiMatrix4x4 global_transform(const aiNode* node) {
  aiMatrix4x4 global;
  for (; node; node = node->mParent) global = node->mTransformation * global;
  return global;
}

bool similar(const aiMatrix4x4& a, const aiMatrix4x4& b) {
  for (unsigned row = 0; row < 4; ++row) {
    for (unsigned column = 0; column < 4; ++column) {
      const float tolerance = 1e-3f * std::max(1.0f, std::abs(a[row][column]));
      if (!(std::abs(a[row][column] - b[row][column]) <= tolerance)) return false;
    }
  }
  return true;
}

/// Where a skinned mesh lies in the file's frame at its bind pose: its bones say so, not its node
/// (glTF 2.0 section 3.7.3.3). Bones that do not stand as at the bind pose say nothing.
aiMatrix4x4 file_from_skinned_mesh(const aiScene& scene, const aiMesh& mesh) {
  std::optional<aiMatrix4x4> common;
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    const aiNode* node = scene.mRootNode->FindNode(mesh.mBones[i]->mName);
    if (!node) return {};
    const aiMatrix4x4 here = global_transform(node) * mesh.mBones[i]->mOffsetMatrix;
    if (!common) common = here;
    if (!similar(*common, here)) return {};
  }
  return common.value_or(aiMatrix4x4());
}

void add_bones(const aiMesh& mesh, const aiMatrix4x4& file_from_mesh, Bones& known, Scene& out) {
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    const aiBone& bone = *mesh.mBones[i];
    const std::string name = bone.mName.C_Str();
    aiMatrix4x4 mesh_from_bone = bone.mOffsetMatrix;
    mesh_from_bone.Inverse();
    const aiMatrix4x4 file_from_bone = file_from_mesh * mesh_from_bone;
    BoneNode node;
    node.name = name;
    for (unsigned k = 0; k < 16; ++k) {
      node.file_from_bone[k] = static_cast<double>(file_from_bone[k / 4][k % 4]);
    }
    const auto [entry, is_new] = known.emplace(name, static_cast<std::uint32_t>(out.bones.size()));
    if (is_new) {
      out.bones.push_back(node);
      continue;
    }
    const auto& before = out.bones[entry->second].file_from_bone;
    for (unsigned k = 0; k < 16; ++k) {
      if (std::abs(before[k] - node.file_from_bone[k]) >
          1e-3 * std::max(1.0, std::abs(before[k]))) {
        throw std::runtime_error("bone '" + name + "' stands in two places at the bind pose");
      }
    }
  }
}

void find_parents(const aiScene& scene, const Bones& known, Scene& out) {
  for (BoneNode& bone : out.bones) {
    const aiNode* node = scene.mRootNode->FindNode(bone.name.c_str());
    for (node = node ? node->mParent : nullptr; node; node = node->mParent) {
      if (known.contains(node->mName.C_Str())) {
        bone.parent = node->mName.C_Str();
        break;
      }
    }
  }
}

MeshPart convert_mesh(const aiMesh& mesh, const aiMatrix4x4& file_from_mesh, const Bones& bones) {
  MeshPart part;
  part.name = mesh.mName.C_Str();
  part.material = mesh.mMaterialIndex;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D p = file_from_mesh * mesh.mVertices[i];
    part.positions.push_back({p.x, p.y, p.z});
    if (mesh.HasTextureCoords(0)) {
      part.uvs.push_back({mesh.mTextureCoords[0][i].x, mesh.mTextureCoords[0][i].y});
    }
  }
  const bool flipped = file_from_mesh.Determinant() < 0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    part.triangles.push_back(
        {face.mIndices[0], face.mIndices[flipped ? 2 : 1], face.mIndices[flipped ? 1 : 2]});
  }
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    const aiBone& bone = *mesh.mBones[i];
    const std::uint32_t index = bones.at(bone.mName.C_Str());
    for (unsigned k = 0; k < bone.mNumWeights; ++k) {
      const aiVertexWeight& weight = bone.mWeights[k];
      if (weight.mWeight != 0) part.weights.push_back({index, weight.mVertexId, weight.mWeight});
    }
  }
  return part;
}

void add_meshes(const aiScene& scene, const aiNode& node, Bones& bones, Scene& out) {
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    const aiMatrix4x4 file_from_mesh =
        mesh.HasBones() ? file_from_skinned_mesh(scene, mesh) : global_transform(&node);
    add_bones(mesh, file_from_mesh, bones, out);
    out.meshes.push_back(convert_mesh(mesh, file_from_mesh, bones));
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    add_meshes(scene, *node.mChildren[i], bones, out);
  }
}

Material convert_material(const aiMaterial& material) {
  Material converted;
  aiColor4D color(0.8f, 0.8f, 0.8f, 1.0f);
  if (material.Get(AI_MATKEY_BASE_COLOR, color) != aiReturn_SUCCESS) {
    material.Get(AI_MATKEY_COLOR_DIFFUSE, color);
  }
  converted.color = {color.r, color.g, color.b};
  aiString path;
  if (material.GetTexture(aiTextureType_BASE_COLOR, 0, &path) == aiReturn_SUCCESS ||
      material.GetTexture(aiTextureType_DIFFUSE, 0, &path) == aiReturn_SUCCESS) {
    converted.texture = path.C_Str();
  }
  return converted;
}

Texture convert_texture(const aiTexture& texture) {
  Texture converted;
  const char* data = reinterpret_cast<const char*>(texture.pcData);
  if (texture.mHeight == 0) {
    converted.bytes.assign(data, texture.mWidth);
  } else {
    converted.width = texture.mWidth;
    converted.height = texture.mHeight;
    converted.bytes.assign(data, std::size_t{4} * texture.mWidth * texture.mHeight);
  }
  return converted;
}

/// The glTF importer passes over triangles whose vertices do not exist.
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

Scene read(const std::string& file) {
  Assimp::Importer importer;
  std::string extension = file.substr(file.rfind('.') + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
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
  Bones bones;
  add_meshes(*scene, *scene->mRootNode, bones, out);
  find_parents(*scene, bones, out);
  for (unsigned i = 0; i < scene->mNumMaterials; ++i) {
    out.materials.push_back(convert_material(*scene->mMaterials[i]));
  }
  for (unsigned i = 0; i < scene->mNumTextures; ++i) {
    out.textures.push_back(convert_texture(*scene->mTextures[i]));
  }
  return out;
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
}  // namespace hypotrack::mesh_wire

int main(int argc, char** argv) {
  namespace wire = hypotrack::mesh_wire;
  unsigned seconds = 0;
  if (argc != 3 ||
      std::from_chars(argv[2], argv[2] + std::string_view(argv[2]).size(), seconds).ec !=
          std::errc()) {
    return 2;
  }
  wire::limit_resources(seconds);
  wire::Scene scene;
  try {
    scene = wire::read(argv[1]);
  } catch (const std::exception& error) {
    scene = {};
    scene.error = error.what();
  }
  return wire::write_all(wire::encode(scene)) ? 0 : 1;
}
