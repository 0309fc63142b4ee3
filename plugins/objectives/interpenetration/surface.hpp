#pragma once

#include <Eigen/Core>
#include <vector>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack::interpenetration {

/// The triangles of a mesh at the bind pose.
class Surface {
 public:
  explicit Surface(const Mesh& mesh);

  /// Returns the unsigned distance of a point from the surface, in metres.
  double distance(const Eigen::Vector3d& point) const;
  /// Returns the volume that a closed surface encloses, in cubic metres.
  double volume() const;

 private:
  struct Triangle {
    Eigen::Matrix3d corners;  // columns
    Eigen::Vector3d center;
    double radius;  // of the bounding sphere about the centre
  };
  std::vector<Triangle> triangles_;
};

}  // namespace hypotrack::interpenetration
