#include "editable_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector3d;

/// A triangle may turn by about 70 degrees in one edit.
constexpr double kLeastCosine = 0.35;

}  // namespace

EditableMesh::EditableMesh(const TriangleMesh& mesh)
    : vertices_(mesh.vertices), triangles_(mesh.triangles), fans_(mesh.vertices.size()) {
  for (size_t t = 0; t < triangles_.size(); ++t)
    for (int v : triangles_[t]) fans_[v].push_back(static_cast<int>(t));
  for (const auto& fan : fans_) alive_ += !fan.empty();
}

std::vector<int> EditableMesh::neighbours(int v) const {
  std::vector<int> around;
  for (int t : fans_[v])
    for (int u : triangles_[t])
      if (u != v) around.push_back(u);
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  return around;
}

std::vector<std::pair<int, int>> EditableMesh::edges() const {
  std::vector<std::pair<int, int>> all;
  for (int v = 0; v < capacity(); ++v)
    for (int u : neighbours(v))
      if (v < u) all.emplace_back(v, u);
  return all;
}

bool EditableMesh::has_edge(int a, int b) const {
  return std::any_of(fans_[a].begin(), fans_[a].end(), [&](int t) {
    return std::find(triangles_[t].begin(), triangles_[t].end(), b) != triangles_[t].end();
  });
}

Vector3d EditableMesh::triangle_normal(const Triangle& t) const {
  return (vertices_[t[1]] - vertices_[t[0]]).cross(vertices_[t[2]] - vertices_[t[0]]);
}

Vector3d EditableMesh::normal(int v) const {
  Vector3d sum = Vector3d::Zero();
  for (int t : fans_[v]) sum += triangle_normal(triangles_[t]);
  return sum;
}

std::pair<int, int> EditableMesh::wings(int a, int b) const {
  std::pair<int, int> found{-1, -1};
  for (int t : fans_[a])
    for (int i = 0; i < 3; ++i) {
      const int u = triangles_[t][i], w = triangles_[t][(i + 1) % 3];
      if (u == a && w == b) found.first = t;
      if (u == b && w == a) found.second = t;
    }
  return found;
}

int EditableMesh::opposite(int triangle, int a, int b) const {
  for (int v : triangles_[triangle])
    if (v != a && v != b) return v;
  return -1;
}

void EditableMesh::replace(int triangle, int from, int to) {
  for (int& v : triangles_[triangle])
    if (v == from) v = to;
}

void EditableMesh::detach(int triangle, int v) { std::erase(fans_[v], triangle); }

void EditableMesh::split(int a, int b, const Vector3d& p) {
  const auto [first, second] = wings(a, b);
  const int m = capacity();
  vertices_.push_back(p);
  fans_.emplace_back();
  ++alive_;
  for (int t : {first, second}) {
    const int c = opposite(t, a, b);
    const int added = static_cast<int>(triangles_.size());
    triangles_.push_back(triangles_[t]);
    replace(added, a, m);  // keeps b
    replace(t, b, m);      // keeps a
    detach(t, b);
    fans_[b].push_back(added);
    fans_[c].push_back(added);
    fans_[m].push_back(t);
    fans_[m].push_back(added);
  }
}

/// Would a triangle of v, other than those at `without`, turn over if v moved to p?
bool EditableMesh::turns_over(int v, int without, const Vector3d& p) const {
  for (int t : fans_[v]) {
    const Triangle& triangle = triangles_[t];
    if (std::find(triangle.begin(), triangle.end(), without) != triangle.end()) continue;
    Vector3d corners[3];
    for (int i = 0; i < 3; ++i) corners[i] = triangle[i] == v ? p : vertices_[triangle[i]];
    const Vector3d after = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const Vector3d before = triangle_normal(triangle);
    if (after.norm() < 1e-6 || after.dot(before) < kLeastCosine * after.norm() * before.norm())
      return true;
  }
  return false;
}

bool EditableMesh::collapse(int a, int b, const Vector3d& p) {
  const std::vector<int> near_a = neighbours(a), near_b = neighbours(b);
  std::vector<int> common;
  std::set_intersection(near_a.begin(), near_a.end(), near_b.begin(), near_b.end(),
                        std::back_inserter(common));
  if (common.size() != 2 || valence(common[0]) <= 3 || valence(common[1]) <= 3) return false;
  if (turns_over(a, b, p) || turns_over(b, a, p)) return false;
  const auto [first, second] = wings(a, b);
  for (int t : {first, second})
    for (int v : Triangle(triangles_[t])) detach(t, v);
  for (int t : fans_[b]) {
    replace(t, b, a);
    fans_[a].push_back(t);
  }
  fans_[b].clear();
  vertices_[a] = p;
  --alive_;
  return true;
}

bool EditableMesh::flip_if_better(int a, int b) {
  const auto [first, second] = wings(a, b);
  const int c = opposite(first, a, b), d = opposite(second, a, b);
  const auto excess = [&](int v, int change) { return std::abs(valence(v) + change - 6); };
  const int before = excess(a, 0) + excess(b, 0) + excess(c, 0) + excess(d, 0);
  const int after = excess(a, -1) + excess(b, -1) + excess(c, 1) + excess(d, 1);
  if (after >= before || valence(a) <= 3 || valence(b) <= 3 || has_edge(c, d)) return false;
  const Triangle one{c, d, b}, two{d, c, a};  // first had a before b
  const Vector3d old = triangle_normal(triangles_[first]).normalized() +
                       triangle_normal(triangles_[second]).normalized();
  for (const Triangle& t : {one, two}) {
    const Vector3d n = triangle_normal(t);
    double longest = 0;
    for (int i = 0; i < 3; ++i)
      longest = std::max(longest, (vertices_[t[i]] - vertices_[t[(i + 1) % 3]]).squaredNorm());
    if (n.dot(old) < 0.7 * n.norm() * old.norm() || n.norm() < 0.25 * longest) return false;
  }
  triangles_[first] = one;
  triangles_[second] = two;
  detach(first, a);
  detach(second, b);
  fans_[d].push_back(first);
  fans_[c].push_back(second);
  return true;
}

TriangleMesh EditableMesh::compact() const {
  TriangleMesh mesh;
  std::vector<int> renamed(vertices_.size(), -1);
  for (int v = 0; v < capacity(); ++v)
    if (alive(v)) {
      renamed[v] = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(vertices_[v]);
    }
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    const Triangle& triangle = triangles_[t];
    const auto& fan = fans_[triangle[0]];
    if (std::find(fan.begin(), fan.end(), t) != fan.end())
      mesh.triangles.push_back({renamed[triangle[0]], renamed[triangle[1]], renamed[triangle[2]]});
  }
  return mesh;
}

}  // namespace hypotrack::hand_mesh
