#include "imported_motion.hpp"

#include <assimp/scene.h>

#include <algorithm>
#include <span>
#include <stdexcept>

namespace hypotrack::test {
namespace {

Eigen::Isometry3d transform(const aiMatrix4x4& m) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1,
      m.d2, m.d3, m.d4;
  return out;
}

Eigen::Vector3d mixed(const aiVector3D& a, const aiVector3D& b, double share) {
  return (1 - share) * Eigen::Vector3d(a.x, a.y, a.z) + share * Eigen::Vector3d(b.x, b.y, b.z);
}

Eigen::Quaterniond mixed(const aiQuaternion& a, const aiQuaternion& b, double share) {
  return Eigen::Quaterniond(a.w, a.x, a.y, a.z)
      .slerp(share, Eigen::Quaterniond(b.w, b.x, b.y, b.z))
      .normalized();
}

/// Interpolates the keys on both sides of a time.
template <class Key>
auto value_at(std::span<const Key> keys, double ticks) {
  const auto after = std::ranges::upper_bound(keys, ticks, {}, &Key::mTime);
  if (after == keys.begin()) return mixed(keys.front().mValue, keys.front().mValue, 0);
  const Key& before = *(after - 1);
  if (after == keys.end()) return mixed(before.mValue, before.mValue, 0);
  return mixed(before.mValue, after->mValue,
               (ticks - before.mTime) / (after->mTime - before.mTime));
}

void place(const aiNode& node, const Eigen::Isometry3d& above, const aiAnimation& animation,
           double ticks, std::map<std::string, Eigen::Isometry3d>& out) {
  Eigen::Isometry3d local = transform(node.mTransformation);
  for (const aiNodeAnim* channel : std::span(animation.mChannels, animation.mNumChannels)) {
    if (channel->mNodeName != node.mName) continue;
    if (channel->mNumPositionKeys > 0)
      local.translation() = value_at(
          std::span<const aiVectorKey>(channel->mPositionKeys, channel->mNumPositionKeys), ticks);
    if (channel->mNumRotationKeys > 0)
      local.linear() =
          value_at(std::span<const aiQuatKey>(channel->mRotationKeys, channel->mNumRotationKeys),
                   ticks)
              .toRotationMatrix();
  }
  const Eigen::Isometry3d file_from_node = above * local;
  out[node.mName.C_Str()] = file_from_node;
  for (const aiNode* child : std::span(node.mChildren, node.mNumChildren))
    place(*child, file_from_node, animation, ticks, out);
}

/// Returns the node that holds a mesh; null if there is none below.
const aiNode* node_of(const aiNode& node, const aiScene& scene, const aiMesh& mesh) {
  for (const unsigned index : std::span(node.mMeshes, node.mNumMeshes))
    if (scene.mMeshes[index] == &mesh) return &node;
  for (const aiNode* child : std::span(node.mChildren, node.mNumChildren))
    if (const aiNode* found = node_of(*child, scene, mesh)) return found;
  return nullptr;
}

}  // namespace

ImportedMotion::ImportedMotion(const std::filesystem::path& file)
    : scene_(importer_.ReadFile(file.string(), 0)) {
  if (scene_ == nullptr) throw std::runtime_error(importer_.GetErrorString());
  if (scene_->mNumAnimations != 1) throw std::runtime_error("the file has not one animation");
}

double ImportedMotion::duration() const { return scene_->mAnimations[0]->mDuration; }
double ImportedMotion::ticks_per_second() const { return scene_->mAnimations[0]->mTicksPerSecond; }

std::map<std::string, Eigen::Isometry3d> ImportedMotion::nodes_at(double ticks) const {
  std::map<std::string, Eigen::Isometry3d> out;
  place(*scene_->mRootNode, Eigen::Isometry3d::Identity(), *scene_->mAnimations[0], ticks, out);
  return out;
}

Eigen::Matrix3Xd ImportedMotion::vertices_at(double ticks, const aiMesh& mesh) const {
  const auto nodes = nodes_at(ticks);
  Eigen::Matrix3Xd bind(3, mesh.mNumVertices);
  for (Eigen::Index v = 0; v < bind.cols(); ++v)
    bind.col(v) << mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z;
  if (mesh.mNumBones == 0)
    return nodes.at(node_of(*scene_->mRootNode, *scene_, mesh)->mName.C_Str()) * bind;
  Eigen::Matrix3Xd posed = Eigen::Matrix3Xd::Zero(3, bind.cols());
  for (const aiBone* bone : std::span(mesh.mBones, mesh.mNumBones)) {
    const Eigen::Isometry3d file_from_bind =
        nodes.at(bone->mName.C_Str()) * transform(bone->mOffsetMatrix);
    for (const aiVertexWeight& w : std::span(bone->mWeights, bone->mNumWeights))
      posed.col(w.mVertexId) += w.mWeight * (file_from_bind * bind.col(w.mVertexId));
  }
  return posed;
}

}  // namespace hypotrack::test
