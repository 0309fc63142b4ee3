#pragma once

#include <Eigen/Core>

namespace hypotrack::test {

/// How often a surface winds around a point: 1 inside of a closed surface, 0 outside. An open patch
/// gives a fraction: over 1/2 behind it and near to it. (Jacobson, Kavan and Sorkine-Hornung,
/// "Robust inside-outside segmentation using generalized winding numbers", 2013.)
double winding_number(const Eigen::Vector3f& point, const Eigen::Matrix3Xf& vertices,
                      const Eigen::Matrix3Xi& triangles);

/// Distance from a point to the nearest point of a surface.
double distance(const Eigen::Vector3f& point, const Eigen::Matrix3Xf& vertices,
                const Eigen::Matrix3Xi& triangles);

/// How deep the deepest of the points lies behind a surface; 0 if none does.
double penetration(const Eigen::Matrix3Xf& points, const Eigen::Matrix3Xf& vertices,
                   const Eigen::Matrix3Xi& triangles);

/// Distance from the nearest of the points to a surface.
double clearance(const Eigen::Matrix3Xf& points, const Eigen::Matrix3Xf& vertices,
                 const Eigen::Matrix3Xi& triangles);

}  // namespace hypotrack::test
