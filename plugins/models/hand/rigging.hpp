#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/plugin/model.hpp"
#include "rig.hpp"

namespace hypotrack {

inline constexpr double kSameThing = 1e-4;  // metres: points closer than this give no direction

/// A hand under construction. rig_hand() applies the steps below one after the other; each reads
/// the results of those before it.
struct Rigging {
  Rigging(ImportedMesh imported, const Rig& its_rig, const std::string& its_name);

  [[noreturn]] void fail(const std::string& what) const;

  // Look up the index of a name; `who` says in the message who gave an unknown name.
  std::size_t file_bone(const std::string& name, const std::string& who) const;
  int rig_bone(const std::string& name, const std::string& who) const;
  int angle_index(const std::string& name, const std::string& who) const;

  ImportedMesh in;
  const Rig& rig;
  const std::string& where;
  std::map<std::string, std::size_t> file_bones;
  std::vector<std::string> file_names;
  std::map<std::string, int> rig_bones;
  std::vector<std::string> rig_names;
  std::vector<std::string> angle_names;

  Eigen::Isometry3d hand_from_file = Eigen::Isometry3d::Identity();
  ModelData data;
  std::map<std::string, double> bind;  // replacement of a parameter's measured bind angle
  std::map<std::string, int> driven;   // bone that a parameter turns
  std::vector<Eigen::Isometry3d> hand_from_bone;  // of the rig's bones, at the bind pose
  std::vector<Eigen::Vector3d> ends;              // hand frame, at the bind pose
};

/// Returns the name of a bone of the rig for messages.
std::string who(const RigBone& bone);

// --- Steps

/// Mirrors a left hand's file to a right hand's; all later steps are for right hands.
void mirror_in_file(ImportedMesh& imported);

/// Moves vertices and file bones to the hand frame. From here on `file_from_bone` is
/// `hand_from_bone`.
void move_to_hand_frame(Rigging& r);

/// Assigns the vertices to the bones of the rig.
void assign_weights(Rigging& r);

/// Appends the 20 angles to the parameters, with the bounds, rest and bind values of the rig.
void add_angles(Rigging& r);

/// Appends a bone of the rig and the rotations by which parameters turn it.
void add_bone(Rigging& r, std::size_t index);

void add_landmarks(Rigging& r);

/// Removes everything with y < `limit` from a mesh and closes the holes with flat caps, so that it
/// stays watertight. New vertices lie on the cut edges, with the bone influences of the end that is
/// kept. Throws DataError, naming `where`, if nothing is left.
void cut_below(Mesh& mesh, double limit, const std::string& where);

// --- Parts of add_bone()

/// Returns where a bone begins, in the hand frame.
Eigen::Vector3d joint_of(const Rigging& r, const RigBone& bone);

/// Returns where a bone that begins at `joint` ends, in the hand frame.
Eigen::Vector3d end_of(const Rigging& r, std::size_t index, const Eigen::Vector3d& joint);

/// Returns the bone against which a bone's angles are measured: its parent, or the moving bone with
/// which that is rigid.
int moving_parent(const Rigging& r, int parent);

/// Returns the axis about which a bone bends, in the hand frame. It is not yet perpendicular to
/// `y`, the bone's direction. `zero` has the axes of its zero frame.
Eigen::Vector3d flexion_axis(const Rigging& r, std::size_t index, int parent,
                             const Eigen::Matrix3d& zero, const Eigen::Vector3d& y);

/// Lets the parameter `name` (none if empty) turn a bone about an axis in its frame. `measured` is
/// the angle at the bind pose.
void drive(Rigging& r, std::size_t index, const std::string& name, const Eigen::Vector3d& axis,
           double measured);

/// The three angles of a bone in its zero frame (rig.hpp, "Angles"), radians.
struct BoneAngles {
  double abduction = 0;
  double twist = 0;
  double flexion = 0;
};

Eigen::Matrix3d rotation(const BoneAngles& angles);

/// Returns the angles of a rotation; inverse of rotation().
BoneAngles angles_of(const Eigen::Matrix3d& r);

/// Returns the unit vector called x, -x, y, -y, z or -z; nothing for every other name.
std::optional<Eigen::Vector3d> axis_by_name(const std::string& name);

}  // namespace hypotrack
