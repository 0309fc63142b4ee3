#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the pixels (2xN) where another camera may show what a pixel of `camera` shows: its
/// epipolar line, curved by a lens. They go from infinity to 5 cm, evenly in inverse depth. NaN:
/// behind the other camera, or beyond what its lens model describes. Empty: `pixel` has no ray.
Eigen::Matrix2Xd epipolar_line(const Camera& camera, const Eigen::Vector2d& pixel,
                               const Camera& other);

/// Returns the distance of a pixel from the nearest point of an epipolar line, in pixels. Infinite
/// if the line has no two neighbouring points.
double distance_from_line(const Eigen::Matrix2Xd& line, const Eigen::Vector2d& pixel);

/// Projects a world point as project() does. Returns NaN also where the lens model folds back, far
/// outside the image.
Eigen::Vector2d project_uniquely(const Camera& camera, const Eigen::Vector3d& p_world);

/// Returns the world point nearest to the rays of two pixels, metres. NaN if the rays are parallel
/// or nearest to each other behind a camera.
Eigen::Vector3d triangulate(const Camera& a, const Eigen::Vector2d& in_a, const Camera& b,
                            const Eigen::Vector2d& in_b);

}  // namespace internal
}  // namespace hypotrack
