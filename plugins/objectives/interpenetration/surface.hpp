#pragma once

#include <Eigen/Core>
#include <vector>

#include "hypotrack/model.hpp"

namespace hypotrack::interpenetration {

/// The triangles of a mesh at the bind pose.
class Surface {
 public:
  explicit Surface(const Mesh& mesh);

  /// From a point to the nearest point of the surface, metres; from inside as from outside.
  double distance(const Eigen::Vector3d& point) const;
  /// What a closed surface encloses, cubic metres.
  double volume() const;

 private:
  struct Triangle {
    Eigen::Matrix3d corners;  // columns
    Eigen::Vector3d center;
    double radius;  // of a sphere about the centre that holds it
  };
  std::vector<Triangle> triangles_;
};

}  // namespace hypotrack::interpenetration
