#include "drawn_mesh.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace hypotrack::gltf {
namespace {

/// Returns the normal of every face, its length twice the area.
Eigen::Matrix3Xf face_normals(const Mesh& mesh) {
  Eigen::Matrix3Xf normals(3, mesh.triangles.cols());
  for (Eigen::Index t = 0; t < normals.cols(); ++t) {
    const Eigen::Vector3f a = mesh.vertices.col(mesh.triangles(0, t));
    const Eigen::Vector3f b = mesh.vertices.col(mesh.triangles(1, t));
    const Eigen::Vector3f c = mesh.vertices.col(mesh.triangles(2, t));
    normals.col(t) = (b - a).cross(c - a);
  }
  return normals;
}

/// Normals of face corners.
class CornerNormals {
 public:
  explicit CornerNormals(const Mesh& mesh)
      : faces_(face_normals(mesh)), around_(static_cast<std::size_t>(mesh.vertices.cols())) {
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
      for (const int v : mesh.triangles.col(t)) around_[static_cast<std::size_t>(v)].push_back(t);
  }

  /// Returns the mean of the faces around a vertex that lie about as the given one, by area.
  Eigen::Vector3f at(Eigen::Index face, int vertex) const {
    constexpr double kCrease = std::numbers::pi / 4;
    const auto smooth = static_cast<float>(std::cos(kCrease));
    const Eigen::Vector3f own = faces_.col(face);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Eigen::Index other : around_[static_cast<std::size_t>(vertex)]) {
      const Eigen::Vector3f normal = faces_.col(other);
      if (normal.dot(own) >= smooth * normal.norm() * own.norm()) sum += normal;
    }
    // A face without area has no normal, but glTF wants one.
    return sum.norm() > 0 ? Eigen::Vector3f(sum.normalized()) : Eigen::Vector3f::UnitZ();
  }

 private:
  Eigen::Matrix3Xf faces_;
  std::vector<std::vector<Eigen::Index>> around_;  ///< faces by vertex
};

}  // namespace

DrawnMesh drawn_mesh(const Mesh& mesh) {
  const bool has_uv = mesh.uv_triangles.cols() > 0;
  const CornerNormals corner_normals(mesh);
  // Vertex, texture coordinate and normal; corners that have all in common are one vertex.
  std::map<std::pair<std::array<int, 2>, std::array<float, 3>>, std::uint32_t> known;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector2f> uv;
  DrawnMesh drawn;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.triangles(k, t), at = has_uv ? mesh.uv_triangles(k, t) : 0;
      const Eigen::Vector3f n = corner_normals.at(t, vertex);
      const auto next = static_cast<std::uint32_t>(drawn.vertices.size());
      const auto [place, added] = known.try_emplace({{vertex, at}, {n.x(), n.y(), n.z()}}, next);
      drawn.triangles.push_back(place->second);
      if (!added) continue;
      drawn.vertices.push_back(vertex);
      normals.push_back(n);
      if (has_uv) uv.emplace_back(mesh.uv(0, at), 1 - mesh.uv(1, at));
    }
  }
  drawn.normals.resize(3, static_cast<Eigen::Index>(normals.size()));
  for (std::size_t i = 0; i < normals.size(); ++i)
    drawn.normals.col(static_cast<Eigen::Index>(i)) = normals[i];
  drawn.uv.resize(2, static_cast<Eigen::Index>(uv.size()));
  for (std::size_t i = 0; i < uv.size(); ++i) drawn.uv.col(static_cast<Eigen::Index>(i)) = uv[i];
  return drawn;
}

}  // namespace hypotrack::gltf
