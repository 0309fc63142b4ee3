#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "hand_shape.hpp"
#include "the_hand.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector3d;

std::map<std::pair<int, int>, int> directed_edges(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  return edges;
}

double length(const TriangleMesh& mesh, const std::pair<int, int>& edge) {
  return (mesh.vertices[edge.first] - mesh.vertices[edge.second]).norm();
}

/// Does the segment from p to q pass through the triangle?
bool pierces(const Vector3d& p, const Vector3d& q, const std::array<Vector3d, 3>& t) {
  const Vector3d u = t[1] - t[0], v = t[2] - t[0], d = q - p;
  const Vector3d h = d.cross(v);
  const double det = u.dot(h);
  if (std::abs(det) < 1e-12) return false;
  const Vector3d s = p - t[0];
  const double a = s.dot(h) / det, b = d.dot(s.cross(u)) / det, along = v.dot(s.cross(u)) / det;
  return a >= 0 && b >= 0 && a + b <= 1 && along >= 0 && along <= 1;
}

std::array<Vector3d, 3> corners(const TriangleMesh& mesh, const Triangle& t) {
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

bool intersect(const std::array<Vector3d, 3>& a, const std::array<Vector3d, 3>& b) {
  for (int i = 0; i < 3; ++i)
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return true;
  return false;
}

TEST(HandShape, HasThePapersNumberOfVertices) {
  EXPECT_EQ(the_hand().mesh.vertices.size(), static_cast<size_t>(kVertices));
  EXPECT_GE(kVertices, 1300);
  EXPECT_LE(kVertices, 1700);
}

TEST(HandShape, HasExactlyTwoTrianglesAtEveryEdgeWoundAlike) {
  const auto edges = directed_edges(the_hand().mesh);
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1) << edge.first << " " << edge.second;
    ASSERT_TRUE(edges.contains({edge.second, edge.first})) << edge.first << " " << edge.second;
  }
}

TEST(HandShape, IsOnePieceWithoutAHole) {
  const TriangleMesh& mesh = the_hand().mesh;
  const int edges = static_cast<int>(directed_edges(mesh).size()) / 2;
  const int euler =
      static_cast<int>(mesh.vertices.size()) - edges + static_cast<int>(mesh.triangles.size());
  EXPECT_EQ(euler, 2);
  std::vector<bool> reached(mesh.vertices.size(), false);
  reached[0] = true;
  for (bool grows = true; grows;) {
    grows = false;
    for (const Triangle& t : mesh.triangles)
      if (reached[t[0]] || reached[t[1]] || reached[t[2]])
        for (int v : t) {
          grows |= !reached[v];
          reached[v] = true;
        }
  }
  EXPECT_EQ(std::count(reached.begin(), reached.end(), false), 0);
}

TEST(HandShape, IsWoundOutwards) {
  const TriangleMesh& mesh = the_hand().mesh;
  const HandSurface surface;
  EXPECT_GT(volume(mesh, mesh.vertices), 250e3) << "cubic millimetres";
  EXPECT_LT(volume(mesh, mesh.vertices), 500e3) << "cubic millimetres";
  for (const Triangle& t : mesh.triangles) {
    const auto [a, b, c] = corners(mesh, t);
    const Vector3d middle = (a + b + c) / 3;
    ASSERT_GT((b - a).cross(c - a).dot(surface.gradient(middle)), 0) << middle.transpose();
  }
}

TEST(HandShape, HasNoSlivers) {
  const TriangleMesh& mesh = the_hand().mesh;
  for (const Triangle& t : mesh.triangles) {
    const std::array<Vector3d, 3> p = corners(mesh, t);
    for (int i = 0; i < 3; ++i) {
      const Vector3d u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
      const double angle = std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / std::numbers::pi;
      ASSERT_GT(angle, 20) << p[i].transpose();
      ASSERT_LT(angle, 125) << p[i].transpose();
    }
  }
}

TEST(HandShape, HasEdgesOfLikeLengthThatAreShortAtTheTips) {
  const TriangleMesh& mesh = the_hand().mesh;
  std::vector<double> lengths, at_tips;
  std::vector<Vector3d> tips;
  for (int d = 0; d < kDigits; ++d) {
    const SkeletonBone& bone = the_hand().skeleton[bone_index(d, 3)];
    tips.push_back(bone.hand_from_bone * Vector3d(0, bone.length, 0));
  }
  for (const auto& [edge, count] : directed_edges(mesh)) {
    lengths.push_back(length(mesh, edge));
    for (const Vector3d& tip : tips)
      if ((mesh.vertices[edge.first] - tip).norm() < 9) at_tips.push_back(lengths.back());
  }
  std::sort(lengths.begin(), lengths.end());
  std::sort(at_tips.begin(), at_tips.end());
  const double median = lengths[lengths.size() / 2];
  EXPECT_GT(lengths.front(), 0.3 * median);
  EXPECT_LT(lengths.back(), 3.0 * median);
  EXPECT_LT(at_tips[at_tips.size() / 2], median);
}

TEST(HandShape, LiesOnTheImplicitSurface) {
  const HandSurface surface;
  for (const Vector3d& v : the_hand().mesh.vertices) ASSERT_LT(std::abs(surface(v)), 0.05);
}

TEST(HandShape, DoesNotCutItselfAtTheBindPose) {
  const TriangleMesh& mesh = the_hand().mesh;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Triangle& t : mesh.triangles) {
    Eigen::AlignedBox3d box;
    for (int v : t) box.extend(mesh.vertices[v]);
    boxes.push_back(box);
  }
  for (size_t a = 0; a < boxes.size(); ++a)
    for (size_t b = a + 1; b < boxes.size(); ++b) {
      if (!boxes[a].intersects(boxes[b])) continue;
      const Triangle &s = mesh.triangles[a], &t = mesh.triangles[b];
      if (std::find_first_of(s.begin(), s.end(), t.begin(), t.end()) != s.end()) continue;
      ASSERT_FALSE(intersect(corners(mesh, s), corners(mesh, t)))
          << mesh.vertices[s[0]].transpose();
    }
}

}  // namespace
}  // namespace hypotrack::hand_mesh
