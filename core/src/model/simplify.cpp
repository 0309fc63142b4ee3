#include <meshoptimizer.h>

#include <cstddef>
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

}  // namespace

double simplify(ModelData& data, double tolerance) {
  constexpr std::size_t kWorth = 2;  // times fewer triangles
  const Mesh& mesh = data.mesh;
  data.simplified = {};
  const std::vector<unsigned> all(mesh.triangles.data(),
                                  mesh.triangles.data() + mesh.triangles.size());
  const auto vertices = static_cast<std::size_t>(mesh.vertices.cols());
  constexpr std::size_t kStride = 3 * sizeof(float);
  const float size = meshopt_simplifyScale(mesh.vertices.data(), vertices, kStride);
  if (all.empty() || !(tolerance > 0) || !(size > 0)) return 0;
  std::vector<unsigned> fewer(all.size());
  float error = 0;
  fewer.resize(meshopt_simplify(fewer.data(), all.data(), all.size(), mesh.vertices.data(),
                                vertices, kStride, 0, static_cast<float>(tolerance) / size, 0,
                                &error));
  if (fewer.empty() || kWorth * fewer.size() > all.size()) return 0;
  data.simplified = part_of(mesh, fewer);
  return static_cast<double>(error * size);
}

}  // namespace hypotrack
