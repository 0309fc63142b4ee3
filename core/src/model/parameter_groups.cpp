#include <algorithm>
#include <map>
#include <numeric>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
namespace {

/// Disjoint sets of parameters (union-find).
class Sets {
 public:
  explicit Sets(std::size_t count) : leader_(count) {
    std::iota(leader_.begin(), leader_.end(), 0);
  }
  /// Returns the lowest parameter of a parameter's set.
  int of(int parameter) const {
    while (leader_[static_cast<std::size_t>(parameter)] != parameter)
      parameter = leader_[static_cast<std::size_t>(parameter)];
    return parameter;
  }
  void join(int a, int b) {
    a = of(a);
    b = of(b);
    leader_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> leader_;
};

/// Returns one of the parameters that move each bone, -1 for a rigid bone.
std::vector<int> joint_of_bones(const ModelData& data, Sets& sets) {
  std::vector<int> joint(data.bones.size(), -1);
  for (const BoneMotion& motion : data.motions) {
    int& of_bone = joint[static_cast<std::size_t>(motion.bone)];
    if (of_bone < 0) of_bone = motion.parameter;
    sets.join(of_bone, motion.parameter);
  }
  return joint;
}

/// Joins each jointed bone with the nearest jointed bone above it, unless that one has others.
void join_chains(const ModelData& data, const std::vector<int>& joint, Sets& sets) {
  std::vector<int> above(data.bones.size(), -1);  // nearest jointed bone
  std::vector<int> below(data.bones.size(), 0);   // number of jointed bones directly below
  for (std::size_t b = 0; b < data.bones.size(); ++b) {
    if (data.bones[b].parent < 0) continue;
    const auto parent = static_cast<std::size_t>(data.bones[b].parent);
    above[b] = joint[parent] >= 0 ? data.bones[b].parent : above[parent];
    if (joint[b] >= 0 && above[b] >= 0) ++below[static_cast<std::size_t>(above[b])];
  }
  for (std::size_t b = 0; b < data.bones.size(); ++b) {
    if (joint[b] < 0 || above[b] < 0 || below[static_cast<std::size_t>(above[b])] > 1) continue;
    sets.join(joint[b], joint[static_cast<std::size_t>(above[b])]);
  }
}

}  // namespace

std::vector<std::vector<int>> parameter_groups(const ModelData& data) {
  Sets sets(data.parameters.size());
  for (int i = 1; i < static_cast<int>(data.parameters.size()); ++i) {
    if (!is_joint(data.parameters[static_cast<std::size_t>(i)].kind)) sets.join(0, i);
  }
  join_chains(data, joint_of_bones(data, sets), sets);
  std::map<int, std::vector<int>> by_leader;  // the pose is first: parameter 0 leads it
  for (int i = 0; i < static_cast<int>(data.parameters.size()); ++i) {
    by_leader[sets.of(i)].push_back(i);
  }
  std::vector<std::vector<int>> groups;
  for (auto& [leader, group] : by_leader) groups.push_back(std::move(group));
  return groups;
}

}  // namespace hypotrack
