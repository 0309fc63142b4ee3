#include "extract.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector3d;

/// The six tetrahedra around a cube's diagonal 0-7; bit 0, 1 and 2 of a corner are its x, y and z.
/// All have the same orientation: neighbouring cubes split their common face alike.
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                   {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

class Marcher {
 public:
  Marcher(const std::function<double(const Vector3d&)>& field, const Vector3d& low,
          const Vector3d& high, double cell)
      : low_(low), cell_(cell) {
    for (int i = 0; i < 3; ++i)
      size_[i] = static_cast<int>(std::ceil((high[i] - low[i]) / cell)) + 1;
    values_.resize(static_cast<size_t>(size_[0]) * size_[1] * size_[2]);
    for (int z = 0; z < size_[2]; ++z)
      for (int y = 0; y < size_[1]; ++y)
        for (int x = 0; x < size_[0]; ++x) {
          const int n = node(x, y, z);
          // A vertex in a grid node would collapse triangles there.
          const double value = field(position(n));
          values_[n] = std::abs(value) < 1e-6 ? 1e-6 : value;
        }
  }

  TriangleMesh march() {
    for (int z = 0; z + 1 < size_[2]; ++z)
      for (int y = 0; y + 1 < size_[1]; ++y)
        for (int x = 0; x + 1 < size_[0]; ++x) {
          int corners[8];
          for (int c = 0; c < 8; ++c)
            corners[c] = node(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
          for (const auto& t : kTetrahedra)
            add_tetrahedron({corners[t[0]], corners[t[1]], corners[t[2]], corners[t[3]]});
        }
    return std::move(mesh_);
  }

 private:
  int node(int x, int y, int z) const { return (z * size_[1] + y) * size_[0] + x; }

  Vector3d position(int n) const {
    return low_ +
           cell_ * Vector3d(n % size_[0], n / size_[0] % size_[1], n / (size_[0] * size_[1]));
  }

  /// The vertex where the surface crosses the edge between two nodes.
  int crossing(int a, int b) {
    const auto [entry, added] =
        crossings_.try_emplace(std::minmax(a, b), static_cast<int>(mesh_.vertices.size()));
    if (added) {
      const double t = std::clamp(values_[a] / (values_[a] - values_[b]), 0.02, 0.98);
      mesh_.vertices.push_back((1 - t) * position(a) + t * position(b));
    }
    return entry->second;
  }

  void add_tetrahedron(const std::array<int, 4>& n) {
    // In and out in an even permutation of the corners, so that the orientation stays.
    static constexpr int kLone[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
    static constexpr int kPairs[3][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}};
    std::array<bool, 4> in;
    for (int i = 0; i < 4; ++i) in[i] = values_[n[i]] < 0;
    const int count = in[0] + in[1] + in[2] + in[3];
    if (count == 0 || count == 4) return;
    if (count != 2) {
      const bool lone_in = count == 1;
      for (const auto& p : kLone)
        if (in[p[0]] == lone_in) {
          const Triangle t{crossing(n[p[0]], n[p[1]]), crossing(n[p[0]], n[p[2]]),
                           crossing(n[p[0]], n[p[3]])};
          add_triangle(t, lone_in);
        }
      return;
    }
    for (const auto& p : kPairs)
      if (in[p[0]] == in[p[1]]) {
        const int q[4] = {crossing(n[p[0]], n[p[2]]), crossing(n[p[0]], n[p[3]]),
                          crossing(n[p[1]], n[p[3]]), crossing(n[p[1]], n[p[2]])};
        add_triangle({q[0], q[1], q[2]}, in[p[0]]);
        add_triangle({q[0], q[2], q[3]}, in[p[0]]);
      }
  }

  void add_triangle(const Triangle& t, bool as_is) {
    mesh_.triangles.push_back(as_is ? t : Triangle{t[0], t[2], t[1]});
  }

  Vector3d low_;
  double cell_;
  int size_[3];
  std::vector<double> values_;
  std::map<std::pair<int, int>, int> crossings_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh extract_surface(const std::function<double(const Vector3d&)>& field,
                             const Vector3d& low, const Vector3d& high, double cell) {
  return Marcher(field, low, high, cell).march();
}

}  // namespace hypotrack::hand_mesh
