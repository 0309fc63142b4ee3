#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "model/import/reader/convert.hpp"

namespace hypotrack::mesh_wire::internal {

aiMatrix4x4 global_transform(const aiNode* node) {
  aiMatrix4x4 global;
  for (; node; node = node->mParent) global = node->mTransformation * global;
  return global;
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

}  // namespace hypotrack::mesh_wire::internal
