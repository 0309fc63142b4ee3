#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "object_rig.hpp"

namespace hypotrack::articulated {
namespace {

/// A mechanism of the file's bones and the rig's joints under construction.
class Rigging {
 public:
  Rigging(const std::vector<ImportedBone>& bones, const ObjectRig& rig, const std::string& where)
      : bones_(bones), where_(where) {
    for (std::size_t i = 0; i < bones.size(); ++i) index_.emplace(bones[i].name, i);
    for (const RigJoint& joint : rig.joints) joints_[index_of(joint)].push_back(&joint);
  }

  /// Returns a mechanism whose first links are the file's bones, in their order.
  Mechanism mechanism() {
    Mechanism out;
    for (const ImportedBone& bone : bones_) out.links.push_back(bone.name);
    // A root of its own keeps the file's frame, whatever bones have no parent.
    std::string root = "object";
    while (index_.contains(root)) root += "_";
    out.links.push_back(root);
    for (std::size_t i = 0; i < bones_.size(); ++i) add(i, root, out);
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw DataError(where_ + ": " + what); }

  std::size_t index_of(const RigJoint& joint) const {
    if (const auto found = index_.find(joint.bone); found != index_.end()) return found->second;
    std::vector<std::string> names;
    for (const ImportedBone& bone : bones_) names.push_back(bone.name);
    fail(fmt::format(
        "joint '{}' moves the bone '{}', which the mesh file does not have{}; its "
        "bones are: {}",
        joint.name, joint.bone, did_you_mean(joint.bone, names), fmt::join(names, ", ")));
  }

  /// Joins a bone to its parent: by its joints one after the other, or fixed.
  void add(std::size_t index, const std::string& root, Mechanism& out) {
    const ImportedBone& bone = bones_[index];
    const auto parent = index_.find(bone.parent);
    std::string above = parent == index_.end() ? root : bone.parent;
    Eigen::Isometry3d above_from_bone =
        parent == index_.end()
            ? bone.file_from_bone
            : bones_[parent->second].file_from_bone.inverse() * bone.file_from_bone;
    const std::vector<const RigJoint*>& joints = joints_[index];
    if (joints.empty()) {
      out.joints.push_back({.name = "fixed:" + bone.name, .parent = above, .child = bone.name});
      out.joints.back().parent_from_child = above_from_bone;
    }
    for (std::size_t k = 0; k < joints.size(); ++k) {
      Joint joint = joint_of(*joints[k]);
      const bool is_last = k + 1 == joints.size();
      joint.parent = above;
      joint.child = is_last ? bone.name : fmt::format("{}:{}", bone.name, k + 1);
      joint.parent_from_child = std::exchange(above_from_bone, Eigen::Isometry3d::Identity());
      if (!is_last) out.links.push_back(joint.child);
      above = joint.child;
      out.joints.push_back(std::move(joint));
    }
  }

  Joint joint_of(const RigJoint& from) const {
    const bool slides = from.type == RigJointType::prismatic;
    const std::vector<double>& bounds = slides ? from.bounds_mm : from.bounds_deg;
    const char* key = slides ? "bounds_mm" : "bounds_deg";
    if (!(slides ? from.bounds_deg : from.bounds_mm).empty())
      fail(fmt::format("joint '{}' {}; give {} instead", from.name,
                       slides ? "slides, but has bounds_deg" : "turns, but has bounds_mm", key));
    Joint joint{.name = from.name, .kind = JointKind::revolute};
    if (from.type == RigJointType::continuous) joint.kind = JointKind::continuous;
    if (slides) joint.kind = JointKind::prismatic;
    joint.axis = from.axis;
    joint.rest = slides ? from.rest_mm : from.rest_deg;
    joint.bind = slides ? from.bind_mm : from.bind_deg;
    if (!from.mimic.empty()) {
      joint.mimic = Mimic{from.mimic, from.multiplier, slides ? from.offset_mm : from.offset_deg};
      return joint;
    }
    const bool has_bounds = joint.kind != JointKind::continuous;
    if (bounds.size() != (has_bounds ? 2U : 0U))
      fail(fmt::format("joint '{}' has {} numbers in {}, expected {}", from.name, bounds.size(),
                       key, has_bounds ? "the lowest and the highest value" : "none"));
    if (has_bounds) {
      joint.lower = bounds[0];
      joint.upper = bounds[1];
    }
    return joint;
  }

  const std::vector<ImportedBone>& bones_;
  const std::string& where_;
  std::map<std::string, std::size_t> index_;
  std::map<std::size_t, std::vector<const RigJoint*>> joints_;
};

/// Gives the vertices to the bones of the assembly; adds up the weights of those with the same.
void reassign(Mesh& mesh, const std::vector<LinkPlace>& places) {
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    Eigen::Vector4i bones = Eigen::Vector4i::Zero();
    Eigen::Vector4f weights = Eigen::Vector4f::Zero();
    int count = 0;
    for (int k = 0; k < 4; ++k) {
      const float weight = mesh.bone_weights(k, v);
      if (weight <= 0) continue;
      const int bone = places[static_cast<std::size_t>(mesh.bone_indices(k, v))].bone;
      int slot = 0;
      while (slot < count && bones[slot] != bone) ++slot;
      count = std::max(count, slot + 1);
      bones[slot] = bone;
      weights[slot] += weight;
    }
    mesh.bone_indices.col(v) = bones;
    mesh.bone_weights.col(v) = weights / weights.sum();
  }
}

}  // namespace

Assembly rig_object(const ImportedMesh& imported, const ObjectRig& rig, const std::string& where) {
  if (imported.bones.empty())
    throw DataError(where +
                    ": the mesh file has no bones that could move; skin the mesh to some, or write "
                    "`type: rigid_mesh`");
  Assembly assembly = assemble(Rigging(imported.bones, rig, where).mechanism(), where);
  assembly.data.mesh = imported.mesh;
  reassign(assembly.data.mesh, assembly.links);
  return assembly;
}

}  // namespace hypotrack::articulated
