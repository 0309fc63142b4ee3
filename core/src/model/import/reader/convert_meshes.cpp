#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "model/import/reader/convert.hpp"
#include "model/import/reader/gltf_meshes.hpp"
#include "model/import/srgb.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

bool similar(const aiMatrix4x4& a, const aiMatrix4x4& b) {
  for (unsigned row = 0; row < 4; ++row) {
    for (unsigned column = 0; column < 4; ++column) {
      const float tolerance = 1e-3f * std::max(1.0f, std::abs(a[row][column]));
      if (!(std::abs(a[row][column] - b[row][column]) <= tolerance)) return false;
    }
  }
  return true;
}

/// Returns the transform of a skinned mesh to the file's frame at the bind pose. Its bones define
/// it, not its node (glTF 2.0 section 3.7.3.3). The result is the identity if the bones disagree,
/// because they are then not at the bind pose, which a note tells.
aiMatrix4x4 file_from_skinned_mesh(const aiScene& scene, const aiMesh& mesh, Scene& out) {
  std::optional<aiMatrix4x4> common;
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    const aiNode* node = scene.mRootNode->FindNode(mesh.mBones[i]->mName);
    if (!node) return {};
    const aiMatrix4x4 here = global_transform(node) * mesh.mBones[i]->mOffsetMatrix;
    if (!common) common = here;
    if (similar(*common, here)) continue;
    const char* const note = "the file poses its bones, and is read at their bind pose";
    if (std::ranges::find(out.notes, note) == out.notes.end()) out.notes.emplace_back(note);
    return {};
  }
  return common.value_or(aiMatrix4x4());
}

std::array<std::uint8_t, 3> convert_color(const aiColor4D& color, bool linear) {
  std::array<std::uint8_t, 3> bytes{};
  for (unsigned c = 0; c < 3; ++c)
    bytes[c] = srgb::byte(linear ? srgb::encoded(color[c]) : color[c]);
  return bytes;
}

/// Returns the number that is the brightest in colours of vertices: 1, or the 255 of some programs
/// that write OBJ files. Tells of it.
float brightest_number(const aiScene& scene, Scene& out) {
  float most = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    for (unsigned k = 0; mesh.HasVertexColors(0) && k < mesh.mNumVertices; ++k)
      for (unsigned c = 0; c < 3; ++c) most = std::max(most, mesh.mColors[0][k][c]);
  }
  if (most <= 1.001f || !std::isfinite(most)) return 1;
  const float brightest = most <= 255 ? 255 : most;
  std::string text = std::to_string(brightest);
  text.erase(text.find('.'));
  out.notes.push_back("colours of vertices beyond 1: read as numbers from 0 to " + text);
  return brightest;
}

/// Inputs of the conversion that all meshes share.
struct Context {
  const aiScene& scene;
  const std::vector<PictureUse>& uses;
  bool gltf;        // colours of vertices are linear in light, normals are numbers
  float brightest;  // number in colours of vertices
  Bones& bones;
};

MeshPart convert_mesh(const aiMesh& mesh, const aiMatrix4x4& file_from_mesh,
                      const Context& context) {
  MeshPart part;
  part.name = mesh.mName.C_Str();
  part.material = mesh.mMaterialIndex;
  const PictureUse use =
      part.material < context.uses.size() ? context.uses[part.material] : PictureUse();
  const unsigned set = use.or_first && !mesh.HasTextureCoords(use.set) ? 0 : use.set;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D p = file_from_mesh * mesh.mVertices[i];
    part.positions.push_back({p.x, p.y, p.z});
    if (mesh.HasTextureCoords(set)) {
      part.uvs.push_back({mesh.mTextureCoords[set][i].x, mesh.mTextureCoords[set][i].y});
    }
    if (mesh.HasVertexColors(0))
      part.colors.push_back(
          convert_color(mesh.mColors[0][i] * (1 / context.brightest), context.gltf));
  }
  const bool flipped = file_from_mesh.Determinant() < 0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) continue;  // skip points and lines
    part.triangles.push_back(
        {face.mIndices[0], face.mIndices[flipped ? 2 : 1], face.mIndices[flipped ? 1 : 2]});
  }
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    const aiBone& bone = *mesh.mBones[i];
    const std::uint32_t index = context.bones.at(bone.mName.C_Str());
    for (unsigned k = 0; k < bone.mNumWeights; ++k) {
      const aiVertexWeight& weight = bone.mWeights[k];
      if (weight.mWeight != 0) part.weights.push_back({index, weight.mVertexId, weight.mWeight});
    }
  }
  return part;
}

/// Brings a part's vertices into the order that they have in a glTF file. Vertices that assimp
/// leaves out are copies of another one.
void restore_order(const aiMesh& mesh, MeshPart& part) {
  if (!mesh.HasNormals()) return;
  std::vector<std::uint32_t> numbers;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i)
    numbers.push_back(static_cast<std::uint32_t>(VertexNumber::of(mesh.mNormals[i])));
  if (std::ranges::is_sorted(numbers) && numbers.back() + 1 == numbers.size()) return;
  const auto restore = [&](auto& values) {
    if (values.empty()) return;
    auto sorted = values;
    sorted.assign(*std::ranges::max_element(numbers) + std::size_t{1}, values.front());
    for (std::size_t i = 0; i < numbers.size(); ++i) sorted[numbers[i]] = values[i];
    values = std::move(sorted);
  };
  restore(part.positions);
  restore(part.uvs);
  restore(part.colors);
  for (auto& corners : part.triangles)
    for (std::uint32_t& corner : corners) corner = numbers[corner];
  for (Weight& weight : part.weights) weight.vertex = numbers[weight.vertex];
}

/// The bone that holds a mesh without weights, and the place of its node at the bind pose.
struct Holder {
  std::uint32_t bone = 0;
  aiMatrix4x4 file_from_node{};
};

/// Returns the nearest bone at or above a node; nothing without one.
std::optional<Holder> holder_of(const aiNode& node, const Bones& bones, const Scene& out) {
  aiMatrix4x4 bone_from_node;
  for (const aiNode* at = &node; at; at = at->mParent) {
    if (const auto found = bones.find(at->mName.C_Str()); found != bones.end()) {
      const auto& m = out.bones[found->second].file_from_bone;
      aiMatrix4x4 file_from_bone;
      for (unsigned k = 0; k < 16; ++k) file_from_bone[k / 4][k % 4] = static_cast<ai_real>(m[k]);
      return Holder{found->second, file_from_bone * bone_from_node};
    }
    bone_from_node = at->mTransformation * bone_from_node;
  }
  return std::nullopt;
}

void add_all_bones(const aiNode& node, const Context& context, Scene& out) {
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *context.scene.mMeshes[node.mMeshes[i]];
    if (mesh.HasBones())
      add_bones(mesh, file_from_skinned_mesh(context.scene, mesh, out), context.bones, out);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_all_bones(*node.mChildren[i], context, out);
}

void add_meshes(const aiNode& node, const Context& context, Scene& out) {
  const aiScene& scene = context.scene;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    const auto holder = mesh.HasBones() ? std::nullopt : holder_of(node, context.bones, out);
    const aiMatrix4x4 file_from_mesh = mesh.HasBones() ? file_from_skinned_mesh(scene, mesh, out)
                                       : holder        ? holder->file_from_node
                                                       : global_transform(&node);
    out.meshes.push_back(convert_mesh(mesh, file_from_mesh, context));
    for (unsigned v = 0; holder && v < mesh.mNumVertices; ++v)
      out.meshes.back().weights.push_back({holder->bone, v, 1});
    if (context.gltf) restore_order(mesh, out.meshes.back());
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    add_meshes(*node.mChildren[i], context, out);
  }
}

}  // namespace

void convert_meshes(const aiScene& scene, const std::vector<PictureUse>& uses, bool gltf,
                    Scene& out) {
  Bones bones;
  const float brightest = gltf ? 1 : brightest_number(scene, out);
  const Context context{scene, uses, gltf, brightest, bones};
  add_all_bones(*scene.mRootNode, context, out);
  add_meshes(*scene.mRootNode, context, out);
  find_parents(scene, bones, out);
}

}  // namespace hypotrack::mesh_wire::internal
