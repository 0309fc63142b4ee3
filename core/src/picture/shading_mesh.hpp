#pragma once

#include <Eigen/Core>
#include <vector>

#include "hypotrack/model.hpp"

namespace hypotrack {

/// A mesh cut up for drawing: a vertex of the model becomes several corners where texture
/// coordinates or, at a sharp edge of the bind pose, normals differ.
class ShadingMesh {
 public:
  /// Edges whose faces meet at more than this angle are drawn sharp.
  static constexpr double kCreaseAngle = 0.96;  // 55 degrees

  explicit ShadingMesh(const Mesh& mesh);

  int corner_count() const { return static_cast<int>(vertex_.size()); }
  /// Index of the model's vertex for every corner.
  const std::vector<int>& vertex() const { return vertex_; }
  /// Texture coordinates (2xC), v upwards; zero where the mesh has none.
  const Eigen::Matrix2Xf& uv() const { return uv_; }
  /// Corner indices, 3xT, in the order of the model's triangles.
  const Eigen::Matrix3Xi& triangles() const { return triangles_; }

  /// Positions of the corners (3xC) from those of the model's vertices (3xV).
  Eigen::Matrix3Xf positions(const Eigen::Matrix3Xf& vertices) const;
  /// Unit normals of the corners (3xC), outwards; faces weigh by the angle they have at the corner.
  Eigen::Matrix3Xf normals(const Eigen::Matrix3Xf& vertices) const;

 private:
  std::vector<int> vertex_;
  std::vector<int>
      normal_;  // which of the normals a corner has: corners at a texture seam share one
  int normal_count_ = 0;
  Eigen::Matrix2Xf uv_;
  Eigen::Matrix3Xi triangles_;
};

}  // namespace hypotrack
