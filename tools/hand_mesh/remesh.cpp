#include "remesh.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

#include "editable_mesh.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector3d;

class Remesher {
 public:
  Remesher(const TriangleMesh& fine, const RemeshTarget& target) : mesh_(fine), target_(target) {}

  TriangleMesh run() {
    scale_ = 1.0;
    for (int round = 0; round < 6; ++round) {
      for (int i = 0; i < 5; ++i) pass();
      scale_ *= std::sqrt(static_cast<double>(mesh_.vertex_count()) / target_.vertices);
    }
    scale_ *= 0.99;  // so that the exact number is reached from above
    for (int i = 0; i < 4; ++i) pass();
    reach_count();
    for (int i = 0; i < 30; ++i) {
      flip();
      relax();
    }
    return mesh_.compact();
  }

 private:
  /// Length of an edge in units of the wanted length.
  double relative_length(int a, int b) const {
    const Vector3d &p = mesh_.position(a), &q = mesh_.position(b);
    return (p - q).norm() / (scale_ * target_.edge_length(0.5 * (p + q)));
  }

  void pass() {
    split_long();
    collapse_short();
    flip();
    relax();
  }

  void split_long() {
    for (const auto& [a, b] : mesh_.edges())
      if (relative_length(a, b) > 4.0 / 3.0)
        mesh_.split(a, b, target_.project(0.5 * (mesh_.position(a) + mesh_.position(b))));
  }

  void collapse_short() {
    for (const auto& [a, b] : mesh_.edges()) {
      if (!mesh_.alive(a) || !mesh_.alive(b) || !mesh_.has_edge(a, b)) continue;
      if (relative_length(a, b) < 4.0 / 5.0) collapse(a, b);
    }
  }

  bool collapse(int a, int b) {
    const Vector3d middle = target_.project(0.5 * (mesh_.position(a) + mesh_.position(b)));
    const double limit = 1.4 * scale_ * target_.edge_length(middle);
    for (int v : {a, b})
      for (int u : mesh_.neighbours(v))
        if ((mesh_.position(u) - middle).norm() > limit) return false;
    return mesh_.collapse(a, b, middle);
  }

  void flip() {
    for (const auto& [a, b] : mesh_.edges())
      if (mesh_.has_edge(a, b)) mesh_.flip_if_better(a, b);
  }

  /// Moves every vertex towards the mean of its neighbours, within the surface. Neighbours count by
  /// the inverse of the wanted length, which keeps the grading.
  void relax() {
    for (int v = 0; v < mesh_.capacity(); ++v) {
      if (!mesh_.alive(v)) continue;
      Vector3d mean = Vector3d::Zero();
      double total = 0;
      for (int u : mesh_.neighbours(v)) {
        const double weight = relative_length(u, v) / target_.edge_length(mesh_.position(u));
        mean += weight * mesh_.position(u);
        total += weight;
      }
      const Vector3d p = mesh_.position(v);
      const Vector3d n = mesh_.normal(v).normalized();
      const Vector3d step = 0.6 * (mean / total - p);
      mesh_.move(v, target_.project(p + step - n.dot(step) * n));
    }
  }

  /// Collapses the relatively shortest edges, or splits the longest, until the number is right.
  void reach_count() {
    while (mesh_.vertex_count() != target_.vertices) {
      const bool too_many = mesh_.vertex_count() > target_.vertices;
      std::vector<std::tuple<double, int, int>> order;
      for (const auto& [a, b] : mesh_.edges())
        order.emplace_back(too_many ? relative_length(a, b) : -relative_length(a, b), a, b);
      std::sort(order.begin(), order.end());
      if (!edit_first(order, too_many))
        throw std::runtime_error("hand mesh: cannot reach " + std::to_string(target_.vertices) +
                                 " vertices, stuck at " + std::to_string(mesh_.vertex_count()));
    }
  }

  bool edit_first(const std::vector<std::tuple<double, int, int>>& order, bool collapse_it) {
    for (const auto& [length, a, b] : order) {
      const Vector3d middle = target_.project(0.5 * (mesh_.position(a) + mesh_.position(b)));
      if (!collapse_it) {
        mesh_.split(a, b, middle);
        return true;
      }
      if (mesh_.collapse(a, b, middle)) return true;
    }
    return false;
  }

  EditableMesh mesh_;
  const RemeshTarget& target_;
  double scale_ = 1;
};

}  // namespace

TriangleMesh remesh(const TriangleMesh& fine, const RemeshTarget& target) {
  return Remesher(fine, target).run();
}

}  // namespace hypotrack::hand_mesh
