#pragma once

#include <string>
#include <vector>

// # The rig file
//
// A rig tells hypotrack the meaning of a skinned mesh file's bones, so that the same 27 parameters
// pose any hand. It is YAML; unknown keys are errors. Anatomical data is in the hand frame (right
// hand): origin at the wrist, +X radial (thumb side), +Y distal (to the fingertips), +Z palmar (out
// of the palm). A left hand is the mirror image in x = 0. Its rig says `side: left` and is the same
// otherwise.
//
//   side: right                   # of the hand in the file (default)
//   scale: 1.0                    # metres per unit of the file (default)
//   frame:                        # where the hand frame lies in the file
//     origin: wrist               # file bone; its joint becomes the origin (default: the root's)
//     distal: middle_mcp          # file bone; +Y points from the origin to it ...
//     radial: [little_mcp, index_mcp]    # ... and +X from the first of these to the second (made
//                                 # perpendicular to +Y). +Z then is palmar.
//     # or by the file's axes, either or both: {origin: wrist, x: -z, y: -x} says which file axes
//     # are the hand's +X and +Y
//   flexion_axis: x               # which axis of a file bone its joint bends about (see below)
//   bones:                        # parents before children; the first is the root
//     - {name: wrist, joint: wrist, end: middle_mcp, weights: [wrist, forearm]}
//     - {name: index_1, parent: wrist, joint: index_mcp, end: index_pip,
//        abduction: index_abduction, flexion: index_flexion_1}
//     - {name: index_2, parent: index_1, joint: index_pip, end: index_dip,
//        flexion: index_flexion_2}
//     - {name: index_3, parent: index_2, joint: index_dip, end: index_tip,
//        flexion: index_flexion_3}
//     - {name: thumb_1, parent: wrist, joint: thumb_cmc, end: thumb_mcp, zero_deg: [45, -60, 0],
//        abduction: thumb_abduction, flexion: thumb_flexion_1}
//     # ...
//   parameters:                   # optional: only what differs from the anatomical defaults
//     - {name: index_flexion_1, bounds_deg: [-20, 90]}
//   landmarks:                    # optional: only what differs from joints and bone ends
//     - {name: index_tip, bone: index_3, position_mm: [0, 22.5, 4]}
//   cut_mm: 10                    # optional: cut the arm off 10 mm proximal of the origin
//
// ## Bones
//
// A rig bone begins at its `joint`: a file bone's origin, or `joint_at: [x, y, z]` in the file's
// units. It points to its `end`: a file bone, or `end_at`. Without either, the end is the farthest
// vertex among those the bone moves: the tip of a finger whose file has no tip bones. It moves the
// vertices of the file bones in `weights` (default: its `joint`). The hierarchy is the rig's,
// whatever the file's is. Every file bone with vertices must be in exactly one `weights` list. A
// bone that the tracker should not move (forearm, metacarpal, twist helper) joins the list of the
// rig bone that it moves with.
//
// A bone's frame at the bind pose has +Y from joint to end, +X along its flexion axis (made
// perpendicular to +Y), and +Z = X x Y, palmar. `flexion_axis`, for the whole rig or for one bone,
// defines X. `x`, `-x`, `y`, `-y`, `z` or `-z` is that axis of the file bone `joint`. `hand` (the
// default) is the parent's X, without twist. `bend` is the axis about which the joint is already
// bent at the bind pose. `twist_deg` turns X further about +Y. The root bone has the axes of the
// hand frame.
//
// ## Angles
//
// In the parent's frame a bone is rotated by  Z * R(abduction, twist, flexion)  with R = rot(-z,
// abduction) rot(+y, twist) rot(+x, flexion). Abduction is positive towards the thumb side, flexion
// towards the palm. Z is the bone's rotation when all angles are zero: along its parent, unless
// `zero_deg: [abduction, twist, flexion]` replaces it. The first bone of the thumb lies in the
// plane of the palm at 45 degrees, its pad turned 60 degrees towards the fingers: [45, -60, 0] in
// every included rig, so that states can be exchanged between hands. `abduction` and `flexion` name
// the parameters that drive these angles. An angle without a parameter keeps its value of the bind
// pose. A bone without any parameter is rigid with its parent, and "the parent" above is then the
// nearest bone that moves, or the root. So fingers on splayed metacarpals are parallel at zero,
// too.
//
// The angles of the bind pose are measured from the file, so zero is the flat, straight hand
// whatever the file's pose is. A parameter's `bind_deg` replaces the measurement where the geometry
// misleads (the bone then differs by the difference).
//
// ## Parameters and landmarks
//
// Names are fixed. Pose: position_x/y/z, rotation_w/x/y/z. Angles, in this order: thumb_abduction,
// thumb_flexion_1..3 (CMC, MCP, IP), then {index, middle, ring, little} each with _abduction and
// _flexion_1..3 (MCP, PIP, DIP). Each angle must drive exactly one bone. Default bounds are
// anatomical (hand_parameters.cpp cites the sources); `bounds_deg` and `rest_deg` replace them.
//
// 21 landmarks, in this order: wrist; thumb_cmc, thumb_mcp, thumb_ip, thumb_tip; then {index,
// middle, ring, little} each with _mcp, _pip, _dip, _tip. By default they are the origin, the
// joints of the bones that the flexions drive, and the ends of the last ones. `landmarks` replaces
// any of them by a point in a bone's frame (x radial, y distal, z palmar, from its joint), for
// example by the fingertips of a label set.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/mesh_io.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

enum class Side { right, left };
std::span<const std::string_view> enum_names(Side);

/// The position of the hand frame in the file: +X by an axis or two joints, +Y by an axis or a
/// joint.
struct RigFrame {
  std::string origin;
  std::string x;
  std::string y;
  std::string distal;
  std::vector<std::string> radial;

  void visit(ParamVisitor& v);
};

struct RigBone {
  std::string name;
  std::string parent;
  std::string joint;
  std::vector<double> joint_at;  ///< in units of the file
  std::string end;
  std::vector<double> end_at;  ///< in units of the file
  std::vector<std::string> weights;
  std::string flexion_axis;
  double twist = 0;                                ///< radians
  Eigen::Vector3d zero = Eigen::Vector3d::Zero();  ///< abduction, twist, flexion; radians
  std::string abduction;                           ///< parameter; empty: none
  std::string flexion;

  void visit(ParamVisitor& v);
};

struct RigParameter {
  std::string name;
  std::vector<double> bounds;  ///< radians; empty: the default
  std::optional<double> rest;
  std::optional<double> bind;

  void visit(ParamVisitor& v);
};

struct RigLandmark {
  std::string name;
  std::string bone;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< metres

  void visit(ParamVisitor& v);
};

/// The content of a rig file, unchecked against any mesh.
struct Rig {
  Side side = Side::right;
  double scale = 1.0;
  RigFrame frame;
  std::string flexion_axis = "hand";
  std::vector<RigBone> bones;
  std::vector<RigParameter> parameters;
  std::vector<RigLandmark> landmarks;
  std::optional<double> cut;  ///< metres

  void visit(ParamVisitor& v);
};

/// Reads a rig file. Throws ConfigError on anything that the format does not have.
Rig read_rig(const std::filesystem::path& file);

/// Makes a hand of 27 parameters and 21 landmarks from a mesh (imported with the rig's scale) and a
/// rig. `where` names the rig in messages. Throws DataError if they do not fit: bones or parameters
/// that are unknown, missing or used twice, or points that coincide.
ModelData rig_hand(const ImportedMesh& imported, const Rig& rig, const std::string& where);

/// Returns a hint for a message about an unknown name: "; did you mean 'index_tip'?" if a known
/// name is near, otherwise the list of known names.
std::string hint_about(const std::string& name, const std::vector<std::string>& known);

}  // namespace hypotrack
