#include "rigging.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "hand_parameters.hpp"
#include "hypotrack/api/error.hpp"
#include "rig.hpp"

namespace hypotrack {

std::string who(const RigBone& bone) { return fmt::format("bone '{}'", bone.name); }

Rigging::Rigging(ImportedMesh imported, const Rig& its_rig, const std::string& its_name)
    : in(std::move(imported)), rig(its_rig), where(its_name) {
  if (in.bones.empty()) fail("the mesh has no bones: a hand needs a skinned mesh");
  if (rig.bones.empty()) fail("the rig lists no bones");
  for (std::size_t i = 0; i < in.bones.size(); ++i) {
    file_bones[in.bones[i].name] = i;
    file_names.push_back(in.bones[i].name);
  }
  for (std::size_t i = 0; i < rig.bones.size(); ++i) {
    if (!rig_bones.emplace(rig.bones[i].name, static_cast<int>(i)).second) {
      fail(fmt::format("two bones are named '{}'", rig.bones[i].name));
    }
    rig_names.push_back(rig.bones[i].name);
  }
  for (const Parameter& angle : hand_angles()) angle_names.push_back(angle.name);
}

void Rigging::fail(const std::string& what) const { throw DataError(where + ": " + what); }

std::size_t Rigging::file_bone(const std::string& name, const std::string& who) const {
  const auto found = file_bones.find(name);
  if (found == file_bones.end()) {
    fail(fmt::format("{} names the bone '{}', which the mesh file does not have{}", who, name,
                     hint_about(name, file_names)));
  }
  return found->second;
}

int Rigging::rig_bone(const std::string& name, const std::string& who) const {
  const auto found = rig_bones.find(name);
  if (found == rig_bones.end()) {
    fail(fmt::format("{} names the bone '{}', which the rig does not have{}", who, name,
                     hint_about(name, rig_names)));
  }
  return found->second;
}

int Rigging::angle_index(const std::string& name, const std::string& who) const {
  const auto found = std::find(angle_names.begin(), angle_names.end(), name);
  if (found == angle_names.end()) {
    fail(fmt::format("{} names the parameter '{}', which a hand does not have{}", who, name,
                     hint_about(name, angle_names)));
  }
  return static_cast<int>(found - angle_names.begin());
}

ModelData rig_hand(const ImportedMesh& imported, const Rig& rig, const std::string& where) {
  Rigging r(imported, rig, where);
  if (rig.side == Side::left) mirror_in_file(r.in);
  move_to_hand_frame(r);
  assign_weights(r);
  r.data.parameters = pose_parameters();
  add_angles(r);
  for (std::size_t i = 0; i < rig.bones.size(); ++i) add_bone(r, i);
  add_landmarks(r);
  r.data.mesh = std::move(r.in.mesh);
  if (rig.cut) cut_below(r.data.mesh, -*rig.cut, where);
  validate(r.data, where);
  return rig.side == Side::left ? mirrored(r.data) : std::move(r.data);
}

}  // namespace hypotrack
