#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "hypotrack/plugin/model.hpp"
#include "mechanism.hpp"

namespace hypotrack::articulated {

/// A piece of surface that moves with a link: a mesh in the link's frame, without bone weights.
struct Part {
  Mesh mesh;
  std::size_t link = 0;
};

/// Joins the parts to a mesh of the assembled skeleton at its bind pose, with one texture. Throws
/// DataError, beginning with `where`, if the textures are too large together.
Mesh join(const std::vector<Part>& parts, const Assembly& assembly, const std::string& where);

// Closed surfaces about the origin, with texture coordinates, in metres.

/// Makes a box of the given edge lengths. A texture covers every face as a whole.
Mesh box_mesh(const Eigen::Vector3d& size);

/// Makes a cylinder about z. A texture goes around it, from its lower centre to its upper one.
Mesh cylinder_mesh(double radius, double length);

/// Makes a sphere. A texture goes around z, from the lower pole to the upper one.
Mesh sphere_mesh(double radius);

}  // namespace hypotrack::articulated
