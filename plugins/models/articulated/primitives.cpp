#include <cmath>
#include <numbers>
#include <vector>

#include "surface.hpp"

namespace hypotrack::articulated {
namespace {

constexpr int kSides = 32;  // of cylinders and spheres
constexpr int kRings = 16;  // of spheres

struct Profile {
  double radius, z;
};

/// Revolves a line about z. It begins and ends on the axis, and outside is on its right.
Mesh revolved(const std::vector<Profile>& line) {
  const auto rings = static_cast<int>(line.size()) - 2;  // without the ends
  Mesh mesh;
  mesh.vertices.resize(3, kSides * rings + 2);
  mesh.uv.resize(2, (kSides + 1) * (rings + 2));
  const auto vertex = [&](int ring, int side) {
    if (ring == 0) return kSides * rings;
    return ring > rings ? kSides * rings + 1 : kSides * (ring - 1) + side % kSides;
  };
  const auto uv = [](int ring, int side) { return ring * (kSides + 1) + side; };
  std::vector<double> along(line.size());
  for (std::size_t i = 1; i < line.size(); ++i)
    along[i] =
        along[i - 1] + std::hypot(line[i].radius - line[i - 1].radius, line[i].z - line[i - 1].z);
  for (int ring = 0; ring <= rings + 1; ++ring) {
    const auto i = static_cast<std::size_t>(ring);
    for (int side = 0; side <= kSides; ++side) {
      const double turn = 2 * std::numbers::pi * side / kSides;
      mesh.vertices.col(vertex(ring, side)) =
          Eigen::Vector3d(line[i].radius * std::cos(turn), line[i].radius * std::sin(turn),
                          line[i].z)
              .cast<float>();
      mesh.uv.col(uv(ring, side)) =
          Eigen::Vector2d(static_cast<double>(side) / kSides, along[i] / along.back())
              .cast<float>();
    }
  }
  mesh.triangles.resize(3, 2 * kSides * rings);
  mesh.uv_triangles.resize(3, 2 * kSides * rings);
  int face = 0;
  const auto add = [&](int ring_a, int a, int ring_b, int b, int ring_c, int c) {
    mesh.triangles.col(face) << vertex(ring_a, a), vertex(ring_b, b), vertex(ring_c, c);
    mesh.uv_triangles.col(face++) << uv(ring_a, a), uv(ring_b, b), uv(ring_c, c);
  };
  for (int side = 0; side < kSides; ++side) {
    for (int ring = 0; ring <= rings; ++ring) {
      if (ring < rings) add(ring, side, ring + 1, side + 1, ring + 1, side);
      if (ring > 0) add(ring, side, ring, side + 1, ring + 1, side + 1);
    }
  }
  return mesh;
}

}  // namespace

Mesh box_mesh(const Eigen::Vector3d& size) {
  Mesh mesh;
  mesh.vertices.resize(3, 8);
  for (int v = 0; v < 8; ++v)
    for (int axis = 0; axis < 3; ++axis)
      mesh.vertices(axis, v) = static_cast<float>((v >> axis & 1 ? 0.5 : -0.5) * size[axis]);
  mesh.triangles.resize(3, 12);
  mesh.uv_triangles.resize(3, 12);
  mesh.uv = Eigen::Matrix2Xf{{0, 1, 1, 0}, {0, 0, 1, 1}};
  int face = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool positive : {true, false}) {
      const int right = 1 << (axis + 1) % 3, up = 1 << (axis + 2) % 3;
      const int at = positive ? 1 << axis : 0, left = positive ? 0 : right, side = right - left;
      const int corners[] = {at + left, at + side, at + side + up, at + left + up};
      mesh.triangles.col(face) << corners[0], corners[1], corners[2];
      mesh.uv_triangles.col(face++) << 0, 1, 2;
      mesh.triangles.col(face) << corners[0], corners[2], corners[3];
      mesh.uv_triangles.col(face++) << 0, 2, 3;
    }
  }
  return mesh;
}

Mesh cylinder_mesh(double radius, double length) {
  const double end = length / 2;
  return revolved({{0, -end}, {radius, -end}, {radius, end}, {0, end}});
}

Mesh sphere_mesh(double radius) {
  std::vector<Profile> line;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double polar = std::numbers::pi * ring / kRings;
    line.push_back({radius * std::sin(polar), -radius * std::cos(polar)});
  }
  return revolved(line);
}

}  // namespace hypotrack::articulated
