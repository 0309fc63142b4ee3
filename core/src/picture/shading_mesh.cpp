#include "picture/shading_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace hypotrack::internal {
namespace {

/// Disjoint sets of corners (union-find).
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(static_cast<std::size_t>(count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  void merge(int a, int b) { parent_[find(a)] = find(b); }

 private:
  std::vector<int> parent_;
};

Eigen::Matrix3Xf face_normals(const Eigen::Matrix3Xf& vertices, const Eigen::Matrix3Xi& triangles) {
  Eigen::Matrix3Xf normals(3, triangles.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3f a = vertices.col(triangles(0, t));
    const Eigen::Vector3f n =
        (vertices.col(triangles(1, t)) - a).cross(vertices.col(triangles(2, t)) - a);
    const float length = n.norm();
    normals.col(t) = length > 0 ? Eigen::Vector3f(n / length) : Eigen::Vector3f::Zero();
  }
  return normals;
}

/// Groups the 3T face corners: corners of one vertex join if smooth edges connect them.
DisjointSets smooth_corners(const Mesh& mesh) {
  const Eigen::Matrix3Xi& triangles = mesh.triangles;
  const Eigen::Matrix3Xf normals = face_normals(mesh.vertices, triangles);
  const float smooth = static_cast<float>(std::cos(ShadingMesh::kCreaseAngle));
  DisjointSets sets(static_cast<int>(triangles.size()));
  std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> faces_at_edge;
  for (int t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto edge = std::minmax({triangles(k, t), triangles((k + 1) % 3, t)});
      faces_at_edge[edge].emplace_back(t, k);
    }
  }
  const auto corner_of = [&](int t, int vertex) {
    int k = 0;
    while (triangles(k, t) != vertex) ++k;
    return 3 * t + k;
  };
  for (const auto& [edge, faces] : faces_at_edge) {
    for (std::size_t i = 1; i < faces.size(); ++i) {
      const int a = faces[0].first, b = faces[i].first;
      const bool degenerate = normals.col(a).isZero() || normals.col(b).isZero();
      if (!degenerate && normals.col(a).dot(normals.col(b)) < smooth) continue;
      sets.merge(corner_of(a, edge.first), corner_of(b, edge.first));
      sets.merge(corner_of(a, edge.second), corner_of(b, edge.second));
    }
  }
  return sets;
}

}  // namespace

ShadingMesh::ShadingMesh(const Mesh& mesh) : triangles_(3, mesh.triangles.cols()) {
  DisjointSets smooth = smooth_corners(mesh);
  const bool has_uv = mesh.uv_triangles.cols() == mesh.triangles.cols();
  std::map<std::tuple<int, int, int>, int> known;
  std::map<int, int> normal_of_set;
  std::vector<Eigen::Vector2f> uv;
  for (int t = 0; t < triangles_.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.triangles(k, t);
      const int uv_index = has_uv ? mesh.uv_triangles(k, t) : -1;
      const int set = smooth.find(3 * t + k);
      const auto [place, added] = known.try_emplace({vertex, uv_index, set}, corner_count());
      if (added) {
        vertex_.push_back(vertex);
        normal_.push_back(normal_of_set.try_emplace(set, normal_count_).first->second);
        normal_count_ = static_cast<int>(normal_of_set.size());
        uv.push_back(has_uv ? Eigen::Vector2f(mesh.uv.col(uv_index)) : Eigen::Vector2f::Zero());
      }
      triangles_(k, t) = place->second;
    }
  }
  uv_.resize(2, corner_count());
  for (int i = 0; i < corner_count(); ++i) uv_.col(i) = uv[i];
}

Eigen::Matrix3Xf ShadingMesh::positions(const Eigen::Matrix3Xf& vertices) const {
  Eigen::Matrix3Xf positions(3, corner_count());
  for (int i = 0; i < corner_count(); ++i) positions.col(i) = vertices.col(vertex_[i]);
  return positions;
}

Eigen::Matrix3Xf ShadingMesh::normals(const Eigen::Matrix3Xf& vertices) const {
  Eigen::Matrix3Xf sums = Eigen::Matrix3Xf::Zero(3, normal_count_);
  for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
    Eigen::Matrix3f edges;  // column k: from corner k to corner k + 1, unit length
    for (int k = 0; k < 3; ++k) {
      const int from = vertex_[triangles_(k, t)], to = vertex_[triangles_((k + 1) % 3, t)];
      edges.col(k) = (vertices.col(to) - vertices.col(from)).normalized();
    }
    const Eigen::Vector3f normal = edges.col(0).cross(edges.col(1)).normalized();
    for (int k = 0; k < 3; ++k) {
      const float cosine = std::clamp(-edges.col(k).dot(edges.col((k + 2) % 3)), -1.0F, 1.0F);
      sums.col(normal_[triangles_(k, t)]) += std::acos(cosine) * normal;
    }
  }
  Eigen::Matrix3Xf normals(3, corner_count());
  for (int i = 0; i < corner_count(); ++i) normals.col(i) = sums.col(normal_[i]).normalized();
  return normals;
}

}  // namespace hypotrack::internal
