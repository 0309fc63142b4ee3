#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack::contour {

/// A point on an edge of a mesh between a triangle that faces the camera and one that does not. In
/// the model's frame.
struct EdgePoint {
  Eigen::Vector3f position;
  Eigen::Vector3f direction;    ///< unit, along the edge
  Eigen::Vector3f front, back;  ///< unit normals of both triangles; zero at an open or smooth edge
};

/// Edges of a mesh that can be its outline. Outlines that are traced in a drawn picture are exact
/// to a pixel only, and say nothing about whether an edge is still the outline from elsewhere.
class SilhouetteEdges {
 public:
  explicit SilhouetteEdges(const Mesh& mesh);

  /// Projects the edges that are the silhouette as a camera sees it; lens distortion is left out.
  void see(const Camera& camera);

  /// Returns the point on the seen edge next to a pixel, of those about perpendicular to `normal`.
  /// Nothing if none is within two pixels.
  std::optional<EdgePoint> nearest(const Eigen::Vector2f& pixel,
                                   const Eigen::Vector2f& normal) const;

 private:
  struct Edge {
    Eigen::Vector3f from, to;
    Eigen::Vector3f normals[2];  ///< of its triangles; the second is zero at an open edge
    bool sharp;
  };
  struct SeenEdge {
    Eigen::Vector2f from, to;  ///< pixels
    float from_z, to_z;
    const Edge* edge;
    bool first_is_front;
  };

  std::vector<Edge> edges_;
  std::vector<SeenEdge> seen_;
};

}  // namespace hypotrack::contour
