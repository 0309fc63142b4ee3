#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A mesh prepared for drawing. A vertex of the model becomes several corners where texture
/// coordinates or, at sharp edges of the bind pose, normals differ.
class ShadingMesh {
 public:
  /// Angle between faces, radians, above which their edge is drawn sharp.
  static constexpr double kCreaseAngle = 0.96;  // 55 degrees

  explicit ShadingMesh(const Mesh& mesh);

  int corner_count() const { return static_cast<int>(vertex_.size()); }
  /// Returns the index of the model's vertex for every corner.
  const std::vector<int>& vertex() const { return vertex_; }
  /// Returns the texture coordinates (2xC), v upwards; zero if the mesh has none.
  const Eigen::Matrix2Xf& uv() const { return uv_; }
  /// Returns the corner indices, 3xT, in the order of the model's triangles.
  const Eigen::Matrix3Xi& triangles() const { return triangles_; }

  /// Returns the positions of the corners (3xC) for those of the model's vertices (3xV).
  Eigen::Matrix3Xf positions(const Eigen::Matrix3Xf& vertices) const;
  /// Computes the outward unit normals of the corners (3xC); each face counts by its angle there.
  Eigen::Matrix3Xf normals(const Eigen::Matrix3Xf& vertices) const;

 private:
  std::vector<int> vertex_;
  std::vector<int>
      normal_;  // which of the normals a corner has: corners at a texture seam share one
  int normal_count_ = 0;
  Eigen::Matrix2Xf uv_;
  Eigen::Matrix3Xi triangles_;
};

}  // namespace internal
}  // namespace hypotrack
