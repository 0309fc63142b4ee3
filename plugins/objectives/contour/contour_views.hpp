#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace hypotrack::contour {

/// A point of a model's outline as one camera sees it. Lengths in metres, in the model's frame.
struct ContourPoint {
  Eigen::Vector3f position;
  /// Unit normal, outwards, of the plane through the camera's centre and the outline's tangent.
  Eigen::Vector3f normal;
  /// Unit normals of the mesh's sharp edge there, of the side that is seen and of the other. From
  /// elsewhere the edge is part of the outline only while one faces the camera and the other does
  /// not. Zero: unknown, or the surface is smooth.
  Eigen::Vector3f front, back;
  float inside;   ///< length along the normal over which the model is seen
  float outside;  ///< length along the normal over which it is not
};

/// Outlines of a model from directions all around it.
class ContourViews {
 public:
  /// `centre` is the point that all views look at, in the model's frame. `first` has one index into
  /// `points` per direction (3xV unit vectors), and the number of points at its end.
  ContourViews(const Eigen::Vector3f& centre, Eigen::Matrix3Xf directions,
               std::vector<std::uint32_t> first, std::vector<ContourPoint> points);

  /// Returns the outline that a camera sees, from the direction next to its own.
  std::span<const ContourPoint> seen_by(const Eigen::Isometry3f& camera_from_model) const;

  const Eigen::Vector3f& centre() const { return centre_; }
  /// Returns the radius of a ball about the centre that holds all points.
  float radius() const { return radius_; }
  const Eigen::Matrix3Xf& directions() const { return directions_; }
  std::span<const std::uint32_t> first() const { return first_; }
  std::span<const ContourPoint> points() const { return points_; }

 private:
  Eigen::Vector3f centre_;
  Eigen::Matrix3Xf directions_;
  Eigen::MatrixX3f by_axis_;  ///< the same, a column for each axis: several fit into a vector
  std::vector<std::uint32_t> first_;
  std::vector<ContourPoint> points_;
  float radius_ = 0;
};

/// Returns the corners of an icosahedron whose triangles are split into four `subdivisions` times:
/// 3x(10 * 4^subdivisions + 2) unit vectors.
Eigen::Matrix3Xf sphere_directions(int subdivisions);

}  // namespace hypotrack::contour
