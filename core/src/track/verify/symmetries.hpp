#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the motions of a mesh, other than the identity, that put its surface onto itself. Tries
/// quarter and half turns about its axes of inertia and those of its file.
std::vector<Eigen::Isometry3d> symmetries(const Mesh& mesh);

}  // namespace internal
}  // namespace hypotrack
