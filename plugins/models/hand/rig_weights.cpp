#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "rigging.hpp"

namespace hypotrack {
namespace {

void check_all_assigned(const Rigging& r, const std::vector<int>& rig_of_file) {
  std::set<std::string> left_out;
  for (Eigen::Index v = 0; v < r.in.mesh.vertices.cols(); ++v) {
    for (int k = 0; k < 4; ++k) {
      const auto bone = static_cast<std::size_t>(r.in.mesh.bone_indices(k, v));
      if (r.in.mesh.bone_weights(k, v) > 0 && rig_of_file[bone] < 0) {
        left_out.insert(r.in.bones[bone].name);
      }
    }
  }
  if (!left_out.empty()) {
    r.fail(
        fmt::format("no bone of the rig takes the vertices of the file's bones '{}': add them to "
                    "the `weights` of the bones that they go with",
                    fmt::join(left_out, "', '")));
  }
}

/// Replaces file bones by rig bones; adds up the weights of those with the same rig bone.
void reassign(Rigging& r, Eigen::Index v, const std::vector<int>& rig_of_file) {
  Eigen::Vector4i bones = Eigen::Vector4i::Zero();
  Eigen::Vector4f weights = Eigen::Vector4f::Zero();
  int count = 0;
  for (int k = 0; k < 4; ++k) {
    const float weight = r.in.mesh.bone_weights(k, v);
    if (weight <= 0) continue;
    const int bone = rig_of_file[static_cast<std::size_t>(r.in.mesh.bone_indices(k, v))];
    int slot = 0;
    while (slot < count && bones[slot] != bone) ++slot;
    count = std::max(count, slot + 1);
    bones[slot] = bone;
    weights[slot] += weight;
  }
  r.in.mesh.bone_indices.col(v) = bones;
  r.in.mesh.bone_weights.col(v) = weights / weights.sum();
}

}  // namespace

void assign_weights(Rigging& r) {
  std::vector<int> rig_of_file(r.in.bones.size(), -1);
  for (std::size_t i = 0; i < r.rig.bones.size(); ++i) {
    const RigBone& bone = r.rig.bones[i];
    std::vector<std::string> names = bone.weights;
    if (names.empty() && !bone.joint.empty()) names.push_back(bone.joint);
    for (const std::string& name : names) {
      int& owner = rig_of_file[r.file_bone(name, who(bone) + ", `weights`,")];
      if (owner >= 0) {
        r.fail(fmt::format("the weights of the file's bone '{}' go to both '{}' and '{}'", name,
                           r.rig_names[static_cast<std::size_t>(owner)], bone.name));
      }
      owner = static_cast<int>(i);
    }
  }
  check_all_assigned(r, rig_of_file);
  for (Eigen::Index v = 0; v < r.in.mesh.vertices.cols(); ++v) reassign(r, v, rig_of_file);
}

}  // namespace hypotrack
