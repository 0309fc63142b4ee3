#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/plugin/plugin_object.hpp"
#include "mechanism.hpp"

namespace hypotrack::articulated {

enum class ShapeKind { box, cylinder, sphere, mesh };

/// A shape that a file gives a link, in the link's frame.
struct Visual {
  std::size_t link = 0;
  std::string name{};  ///< for messages: "link 'lid', visual 1"
  Eigen::Isometry3d link_from_visual = Eigen::Isometry3d::Identity();
  ShapeKind kind = ShapeKind::box;
  /// Edge lengths of a box; radius and length of a cylinder; radius of a sphere; a mesh's scale.
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
  std::filesystem::path mesh{};
  std::optional<Eigen::Vector3f> color{};  ///< RGB in [0, 1]
  std::filesystem::path texture{};         ///< empty: that of the mesh, if it has one
};

/// What a URDF file says about an object's looks and joints.
struct Description {
  Mechanism mechanism;
  std::vector<Visual> visuals;
  std::vector<std::string> notes{};  ///< for the user: what is not read, after the file's name
};

/// Reads a URDF file, with all lengths times `scale`. Throws DataError, beginning with the file's
/// name, if it is damaged or has floating or planar joints.
Description read_urdf(const std::filesystem::path& file, double scale = 1);

/// Makes the surface of a visual, in its link's frame. Reads its mesh and texture; `log`
/// receives what the mesh file has that is not used. Throws DataError.
Mesh visual_mesh(const Visual& visual, const std::string& where, const PluginLog& log = {});

}  // namespace hypotrack::articulated
