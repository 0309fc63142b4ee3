#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

bool is_degenerate(const Soup& soup, const Eigen::Vector3i& corners) {
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2]) {
    return true;
  }
  const Eigen::Vector3d a = soup.points.col(corners[0]).cast<double>();
  const Eigen::Vector3d b = soup.points.col(corners[1]).cast<double>();
  const Eigen::Vector3d c = soup.points.col(corners[2]).cast<double>();
  return (b - a).cross(c - a).norm() == 0;
}

/// Welds the points, drops degenerate triangles and numbers the remaining vertices by first use.
Welded weld(const Soup& soup) {
  Welded welded{.same = weld_points(soup.points, soup.influences),
                .triangles = {},
                .points = {},
                .vertex = {}};
  welded.vertex.assign(welded.same.size(), -1);
  for (int t = 0; t < soup.triangles.cols(); ++t) {
    const Eigen::Vector3i corners = soup.triangles.col(t).unaryExpr(
        [&](int corner) { return welded.same[static_cast<std::size_t>(corner)]; });
    if (is_degenerate(soup, corners)) continue;
    welded.triangles.push_back(t);
    for (const int corner : corners) {
      int& vertex = welded.vertex[static_cast<std::size_t>(corner)];
      if (vertex >= 0) continue;
      vertex = static_cast<int>(welded.points.size());
      welded.points.push_back(corner);
    }
  }
  return welded;
}

}  // namespace

Welded fill_surface(const MeshFile& file, const Soup& soup, Mesh& mesh) {
  Welded welded = weld(soup);
  if (welded.triangles.empty()) {
    file.fail("the mesh has no faces: all its triangles are degenerate");
  }
  mesh.vertices.resize(3, static_cast<Eigen::Index>(welded.points.size()));
  for (std::size_t i = 0; i < welded.points.size(); ++i) {
    mesh.vertices.col(static_cast<Eigen::Index>(i)) = soup.points.col(welded.points[i]);
  }
  mesh.triangles.resize(3, static_cast<Eigen::Index>(welded.triangles.size()));
  for (std::size_t t = 0; t < welded.triangles.size(); ++t) {
    mesh.triangles.col(static_cast<Eigen::Index>(t)) =
        soup.triangles.col(welded.triangles[t]).unaryExpr([&](int corner) {
          const int point = welded.same[static_cast<std::size_t>(corner)];
          return welded.vertex[static_cast<std::size_t>(point)];
        });
  }
  return welded;
}

}  // namespace hypotrack::internal
