#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

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

}  // namespace hypotrack::articulated
