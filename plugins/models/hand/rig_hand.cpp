#include "cut.hpp"
#include "rigging.hpp"

namespace hypotrack {

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
