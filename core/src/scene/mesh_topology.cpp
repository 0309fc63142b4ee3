#include "scene/mesh_topology.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace hypotrack::internal {
namespace {

std::uint64_t directed_edge(int from, int to) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32 |
         static_cast<std::uint32_t>(to);
}

// Returns true if every directed edge occurs once, and so does its reverse.
bool is_closed_manifold(const Eigen::Matrix3Xi& triangles) {
  std::vector<std::uint64_t> edges, reversed;
  for (const auto& t : triangles.colwise()) {
    for (int k = 0; k < 3; ++k) {
      edges.push_back(directed_edge(t[k], t[(k + 1) % 3]));
      reversed.push_back(directed_edge(t[(k + 1) % 3], t[k]));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return edges == reversed && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

class Components {
 public:
  explicit Components(Eigen::Index count) : parent_(static_cast<std::size_t>(count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int v) {
    while (at(v) != v) v = at(v) = at(at(v));
    return v;
  }
  void join(int a, int b) { at(find(a)) = find(b); }

 private:
  int& at(int v) { return parent_[static_cast<std::size_t>(v)]; }
  std::vector<int> parent_;
};

}  // namespace

bool is_closed_outwards(const Mesh& mesh) {
  if (!is_closed_manifold(mesh.triangles)) return false;
  Components components(mesh.vertices.cols());
  for (const auto& t : mesh.triangles.colwise()) {
    components.join(t[0], t[1]);
    components.join(t[0], t[2]);
  }
  std::vector<double> volume(static_cast<std::size_t>(mesh.vertices.cols()), 0.0);
  std::vector<int> roots;
  for (const auto& t : mesh.triangles.colwise()) {
    const int root = components.find(t[0]);
    const auto corner = [&](int k) -> Eigen::Vector3d {
      return (mesh.vertices.col(t[k]) - mesh.vertices.col(root)).cast<double>();
    };
    volume[static_cast<std::size_t>(root)] += corner(0).dot(corner(1).cross(corner(2)));
    roots.push_back(root);
  }
  return std::all_of(roots.begin(), roots.end(),
                     [&](int root) { return volume[static_cast<std::size_t>(root)] > 0; });
}

}  // namespace hypotrack::internal
