#pragma once

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// What a camera sees along the row and the column of its principal point, from edge to edge.
struct FieldOfView {
  double horizontal = 0;      ///< radians
  double vertical = 0;        ///< radians
  bool reaches_edges = true;  ///< false: the lens folds before an edge, and the angle ends there
};

/// Returns the field of view of a camera with a size.
FieldOfView field_of_view(const Camera& camera);

}  // namespace internal
}  // namespace hypotrack
