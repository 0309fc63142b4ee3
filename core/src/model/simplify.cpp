#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
namespace {

/// Returns the part of a mesh that some triangles, three vertex indices each, need.
Mesh part_of(const Mesh& mesh, const std::vector<unsigned>& triangles) {
  std::vector<int> place(static_cast<std::size_t>(mesh.vertices.cols()), -1), kept;
  Mesh part;
  part.triangles.resize(3, static_cast<Eigen::Index>(triangles.size() / 3));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    int& at = place[triangles[i]];
    if (at < 0) {
      at = static_cast<int>(kept.size());
      kept.push_back(static_cast<int>(triangles[i]));
    }
    part.triangles.data()[i] = at;
  }
  part.vertices = mesh.vertices(Eigen::all, kept);
  part.bone_indices = mesh.bone_indices(Eigen::all, kept);
  part.bone_weights = mesh.bone_weights(Eigen::all, kept);
  return part;
}

/// Returns the square of a point's distance from a triangle. Ericson 2005, Real-Time Collision
/// Detection, 5.1.5: the regions of corners, edges and face.
float squared_distance(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                       const Eigen::Vector3f& c) {
  const Eigen::Vector3f normal = (b - a).cross(c - a);
  const auto inside = [&](const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
    return normal.dot((to - from).cross(p - from)) >= 0;
  };
  const float area = normal.squaredNorm();
  if (area > 0 && inside(a, b) && inside(b, c) && inside(c, a)) {
    const float height = normal.dot(p - a);
    return height * height / area;
  }
  const auto from_edge = [&](const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
    const Eigen::Vector3f edge = to - from;
    const float length = edge.squaredNorm();
    const float along = length > 0 ? std::clamp(edge.dot(p - from) / length, 0.0F, 1.0F) : 0;
    return (p - from - along * edge).squaredNorm();
  };
  return std::min({from_edge(a, b), from_edge(b, c), from_edge(c, a)});
}

/// Returns the largest distance of a mesh's vertices, of up to 512 of them, from a surface.
double deviation_of(const Mesh& surface, const Mesh& mesh) {
  constexpr Eigen::Index kMost = 512;
  const Eigen::Index step = std::max<Eigen::Index>(1, mesh.vertices.cols() / kMost);
  float largest = 0;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); v += step) {
    float nearest = std::numeric_limits<float>::infinity();
    for (const auto& t : surface.triangles.colwise())
      nearest = std::min(nearest,
                         squared_distance(mesh.vertices.col(v), surface.vertices.col(t[0]),
                                          surface.vertices.col(t[1]), surface.vertices.col(t[2])));
    largest = std::max(largest, nearest);
  }
  return std::sqrt(largest);
}

/// Returns fewer triangles, at an error by meshoptimizer's measure, in metres.
Mesh simplified_at(const Mesh& mesh, float error) {
  const std::vector<unsigned> all(mesh.triangles.data(),
                                  mesh.triangles.data() + mesh.triangles.size());
  const auto vertices = static_cast<std::size_t>(mesh.vertices.cols());
  constexpr std::size_t kStride = 3 * sizeof(float);
  const float size = meshopt_simplifyScale(mesh.vertices.data(), vertices, kStride);
  if (!(size > 0)) return {};
  std::vector<unsigned> fewer(all.size());
  fewer.resize(meshopt_simplify(fewer.data(), all.data(), all.size(), mesh.vertices.data(),
                                vertices, kStride, 0, error / size, 0, nullptr));
  return part_of(mesh, fewer);
}

}  // namespace

double simplify(ModelData& data, double tolerance) {
  constexpr int kTries = 6;
  constexpr double kLess = 0.8;
  constexpr Eigen::Index kWorth = 2;  // times fewer triangles
  data.simplified = {};
  if (data.mesh.triangles.cols() == 0 || !(tolerance > 0)) return 0;
  // Its measure is a mean: flat triangles cut deeper into round surfaces.
  double error = tolerance;
  for (int i = 0; i < kTries; ++i) {
    Mesh fewer = simplified_at(data.mesh, static_cast<float>(error));
    const Eigen::Index count = fewer.triangles.cols();
    if (count == 0 || kWorth * count > data.mesh.triangles.cols()) return 0;
    const double deviation = deviation_of(fewer, data.mesh);
    if (deviation <= tolerance) {
      data.simplified = std::move(fewer);
      return deviation;
    }
    error *= kLess * tolerance / deviation;
  }
  return 0;
}

}  // namespace hypotrack
