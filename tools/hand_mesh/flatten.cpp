#include "flatten.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <tuple>

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixX2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Solver = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int kIterations = 120;

/// The chart's border, counter-clockwise.
std::vector<int> border(const Chart& chart) {
  std::map<std::pair<int, int>, bool> edges;
  for (const Triangle& t : chart.triangles)
    for (int i = 0; i < 3; ++i) edges[{t[i], t[(i + 1) % 3]}] = true;
  std::map<int, int> next;
  for (const auto& [edge, unused] : edges)
    if (!edges.contains({edge.second, edge.first}) && !next.emplace(edge).second)
      throw std::runtime_error("hand mesh: a texture chart touches itself in a vertex");
  const int inner_edges = static_cast<int>(3 * chart.triangles.size() - next.size()) / 2;
  const int euler =
      static_cast<int>(chart.vertices.size() + chart.triangles.size() - next.size()) - inner_edges;
  if (euler != 1) throw std::runtime_error("hand mesh: a texture chart is no disc");
  std::vector<int> loop{next.begin()->first};
  while (next.at(loop.back()) != loop.front()) loop.push_back(next.at(loop.back()));
  return loop;
}

/// Border on a circle, every inner vertex in the mean of its neighbours: never folds.
MatrixX2d tutte(const TriangleMesh& mesh, const Chart& chart) {
  const int n = static_cast<int>(chart.vertices.size());
  const std::vector<int> loop = border(chart);
  std::vector<double> length{0};
  for (size_t i = 0; i < loop.size(); ++i) {
    const Vector3d& a = mesh.vertices[chart.vertices[loop[i]]];
    const Vector3d& b = mesh.vertices[chart.vertices[loop[(i + 1) % loop.size()]]];
    length.push_back(length.back() + (b - a).norm());
  }
  MatrixX2d right = MatrixX2d::Zero(n, 2);
  std::vector<bool> fixed(n, false);
  const double radius = length.back() / (2 * std::numbers::pi);
  for (size_t i = 0; i < loop.size(); ++i) {
    const double angle = length[i] / radius;
    right.row(loop[i]) = radius * Vector2d(std::cos(angle), std::sin(angle)).transpose();
    fixed[loop[i]] = true;
  }
  Triplets entries;
  for (const Triangle& t : chart.triangles)
    for (int i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];  // of an inner vertex, every neighbour is b once
      if (fixed[a]) continue;
      entries.emplace_back(a, a, 1.0);
      if (fixed[b])
        right.row(a) += right.row(b);
      else
        entries.emplace_back(a, b, -1.0);
    }
  for (int v = 0; v < n; ++v)
    if (fixed[v]) entries.emplace_back(v, v, 1.0);
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return Solver(matrix).solve(right);
}

/// A triangle's corners in its own plane, and the cotangents of its angles.
struct FlatTriangle {
  std::array<Vector2d, 3> corners;
  std::array<double, 3> cotangents;
};

FlatTriangle lay_down(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double length = (b - a).norm();
  const double along = (c - a).dot(b - a) / length;
  const double height = (b - a).cross(c - a).norm() / length;
  FlatTriangle t{{Vector2d(0, 0), Vector2d(length, 0), Vector2d(along, height)}, {}};
  for (int i = 0; i < 3; ++i) {
    const Vector2d u = t.corners[(i + 1) % 3] - t.corners[i],
                   v = t.corners[(i + 2) % 3] - t.corners[i];
    t.cotangents[i] = u.dot(v) / (u.x() * v.y() - u.y() * v.x());
  }
  return t;
}

/// The rotation that turns a triangle's edges nearest to where they are now.
Matrix2d nearest_rotation(const FlatTriangle& flat, const Triangle& t, const MatrixX2d& uv) {
  double c = 0, s = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Vector2d e = flat.corners[j] - flat.corners[i];
    const Vector2d u = (uv.row(t[j]) - uv.row(t[i])).transpose();
    const double weight = flat.cotangents[(i + 2) % 3];
    c += weight * e.dot(u);
    s += weight * (e.x() * u.y() - e.y() * u.x());
  }
  const double norm = std::max(std::hypot(c, s), 1e-12);
  Matrix2d rotation;
  rotation << c, -s, s, c;
  return rotation / norm;
}

MatrixX2d make_rigid(const TriangleMesh& mesh, const Chart& chart, MatrixX2d uv) {
  const int n = static_cast<int>(chart.vertices.size());
  std::vector<FlatTriangle> flats;
  Triplets entries{{0, 0, 1e-3}};  // holds the chart's place
  for (const Triangle& t : chart.triangles) {
    const auto corner = [&](int i) { return mesh.vertices[chart.vertices[t[i]]]; };
    flats.push_back(lay_down(corner(0), corner(1), corner(2)));
    for (int i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      const double w = flats.back().cotangents[(i + 2) % 3];
      for (const auto& [r, c, sign] : {std::tuple{a, a, 1}, {b, b, 1}, {a, b, -1}, {b, a, -1}})
        entries.emplace_back(r, c, sign * w);
    }
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Solver solver(matrix);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    MatrixX2d right = MatrixX2d::Zero(n, 2);
    for (size_t k = 0; k < flats.size(); ++k) {
      const Triangle& t = chart.triangles[k];
      const Matrix2d rotation = nearest_rotation(flats[k], t, uv);
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const Vector2d edge = flats[k].cotangents[(i + 2) % 3] * rotation *
                              (flats[k].corners[i] - flats[k].corners[j]);
        right.row(t[i]) += edge.transpose();
        right.row(t[j]) -= edge.transpose();
      }
    }
    uv = solver.solve(right);
  }
  return uv;
}

}  // namespace

void flatten(const TriangleMesh& mesh, Chart& chart) {
  const MatrixX2d uv = make_rigid(mesh, chart, tutte(mesh, chart));
  for (const Triangle& t : chart.triangles) {
    const Vector2d a = (uv.row(t[1]) - uv.row(t[0])).transpose();
    const Vector2d b = (uv.row(t[2]) - uv.row(t[0])).transpose();
    if (a.x() * b.y() - a.y() * b.x() <= 0)
      throw std::runtime_error("hand mesh: a texture chart folds over");
  }
  chart.flat.clear();
  for (int v = 0; v < uv.rows(); ++v) chart.flat.emplace_back(uv.row(v).transpose());
}

}  // namespace hypotrack::hand_mesh
