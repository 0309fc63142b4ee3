#pragma once

#include <Eigen/Core>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack::articulated {

// Closed surfaces about the origin, with texture coordinates, in metres.

/// Makes a box of the given edge lengths. A texture covers every face as a whole.
Mesh box_mesh(const Eigen::Vector3d& size);

/// Makes a cylinder about z. A texture goes around it, from its lower centre to its upper one.
Mesh cylinder_mesh(double radius, double length);

/// Makes a sphere. A texture goes around z, from the lower pole to the upper one.
Mesh sphere_mesh(double radius);

}  // namespace hypotrack::articulated
