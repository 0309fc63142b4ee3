#pragma once

// # The rig file of an object
//
// A rig tells hypotrack which bones of a skinned mesh file move, and how. Parameters have any
// names.
//
//   scale: 0.001                  # metres per unit of the file (default 1)
//   joints:
//     - {name: lid, bone: lid, axis: [1, 0, 0], bounds_deg: [0, 110]}
//     - {name: tray, bone: tray, type: prismatic, axis: [0, 0, 1], bounds_mm: [0, 80]}
//     - {name: fan, bone: fan, type: continuous, axis: [0, 0, 1]}
//     - {name: jaw, bone: jaw, axis: [0, 1, 0], mimic: lid, multiplier: -0.5, offset_deg: 10}
//
// The bones and their hierarchy are the file's. A bone without a joint is fixed to its parent. A
// bone may have several joints, which apply in their order. An axis is in the bone's own frame and
// goes through its origin. `bind_deg` or `bind_mm` is the value at which the file has the bone
// (default 0), `rest_deg` or `rest_mm` that of the rest pose (default 0, moved into the bounds). A
// joint that mimics another has the value multiplier * value + offset and is no parameter.

#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/api/mesh_io.hpp"
#include "hypotrack/plugin/params.hpp"
#include "mechanism.hpp"

namespace hypotrack::articulated {

enum class RigJointType { revolute, continuous, prismatic };
std::span<const std::string_view> enum_names(RigJointType);

struct RigJoint {
  std::string name;
  std::string bone;
  RigJointType type = RigJointType::revolute;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  std::vector<double> bounds_deg, bounds_mm;  ///< radians and metres
  double rest_deg = 0, rest_mm = 0;
  double bind_deg = 0, bind_mm = 0;
  std::string mimic;
  double multiplier = 1;
  double offset_deg = 0, offset_mm = 0;

  void visit(ParamVisitor& v);
};

/// The content of a rig file, unchecked against any mesh.
struct ObjectRig {
  double scale = 1;
  std::vector<RigJoint> joints;

  void visit(ParamVisitor& v);
};

/// Reads a rig file. Throws ConfigError on anything that the format does not have.
ObjectRig read_object_rig(const std::filesystem::path& file);

/// Assembles a skinned mesh, imported with the rig's scale, with its mesh in the data. The first
/// links are the file's bones. Throws DataError, beginning with `where`, if they do not fit.
Assembly rig_object(const ImportedMesh& imported, const ObjectRig& rig, const std::string& where);

}  // namespace hypotrack::articulated
