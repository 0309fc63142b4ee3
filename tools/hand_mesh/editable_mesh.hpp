#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "triangle_mesh.hpp"

namespace hypotrack::hand_mesh {

/// A closed manifold surface under local edits that keep it so. Removed vertices and triangles stay
/// as gaps until compact().
class EditableMesh {
 public:
  explicit EditableMesh(const TriangleMesh& mesh);

  int vertex_count() const { return alive_; }
  bool alive(int v) const { return !fans_[v].empty(); }
  const Eigen::Vector3d& position(int v) const { return vertices_[v]; }
  void move(int v, const Eigen::Vector3d& p) { vertices_[v] = p; }
  int capacity() const { return static_cast<int>(vertices_.size()); }

  /// Vertices that share an edge with `v`, ascending.
  std::vector<int> neighbours(int v) const;
  int valence(int v) const { return static_cast<int>(fans_[v].size()); }
  /// Every edge once, as (smaller, larger).
  std::vector<std::pair<int, int>> edges() const;
  bool has_edge(int a, int b) const;
  /// Area-weighted, not normalised.
  Eigen::Vector3d normal(int v) const;

  /// Puts a new vertex on an edge.
  void split(int a, int b, const Eigen::Vector3d& p);
  /// Merges b into a at `p`. False, without a change, where the surface would no longer be manifold
  /// or a triangle would turn over.
  bool collapse(int a, int b, const Eigen::Vector3d& p);
  /// Replaces an edge by the other diagonal of its two triangles, if that brings valences nearer to
  /// six and turns no triangle over.
  bool flip_if_better(int a, int b);

  TriangleMesh compact() const;

 private:
  /// The two triangles at an edge: first the one that has a before b.
  std::pair<int, int> wings(int a, int b) const;
  int opposite(int triangle, int a, int b) const;
  Eigen::Vector3d triangle_normal(const Triangle& t) const;
  bool turns_over(int v, int without, const Eigen::Vector3d& p) const;
  void replace(int triangle, int from, int to);
  void detach(int triangle, int v);

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<int>> fans_;  ///< triangles around every vertex
  int alive_ = 0;
};

}  // namespace hypotrack::hand_mesh
