#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

using mesh_wire::MeshPart;

void check_positions(const MeshFile& file, const MeshPart& part) {
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    const auto& p = part.positions[i];
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
      file.fail(
          fmt::format("vertex {} of mesh '{}' is ({}, {}, {}): every coordinate must be finite", i,
                      part.name, p[0], p[1], p[2]));
    }
    const double farthest =
        file.options.scale * std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    if (farthest > kFarthestPoint) {
      file.fail(fmt::format(
          "vertex {} of mesh '{}' lies {:.3g} m from the origin; expected at most {:.0e} m", i,
          part.name, farthest, kFarthestPoint));
    }
  }
}

void check_triangles(const MeshFile& file, const MeshPart& part) {
  for (std::size_t i = 0; i < part.triangles.size(); ++i) {
    for (const std::uint32_t corner : part.triangles[i]) {
      if (corner >= part.positions.size()) {
        file.fail(fmt::format("triangle {} of mesh '{}' names vertex {}, but there are {}", i,
                              part.name, corner, part.positions.size()));
      }
    }
  }
}

void check_uvs(const MeshFile& file, const MeshPart& part) {
  for (const auto& uv : part.uvs) {
    if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) {
      file.fail(fmt::format("mesh '{}' has a texture coordinate ({}, {}): it must be finite",
                            part.name, uv[0], uv[1]));
    }
  }
  if (!part.uvs.empty() && part.uvs.size() != part.positions.size()) {
    file.fail(fmt::format("mesh '{}' has {} texture coordinates for {} vertices", part.name,
                          part.uvs.size(), part.positions.size()));
  }
}

void check_colors(const MeshFile& file, const MeshPart& part) {
  if (!part.colors.empty() && part.colors.size() != part.positions.size()) {
    file.fail(fmt::format("mesh '{}' has {} colours for {} vertices", part.name, part.colors.size(),
                          part.positions.size()));
  }
}

void check_weights(const MeshFile& file, const MeshPart& part) {
  const std::size_t count = part.positions.size();
  for (const mesh_wire::Weight& weight : part.weights) {
    if (weight.vertex >= count || weight.bone >= file.scene.bones.size()) {
      file.fail(fmt::format("a weight of mesh '{}' names vertex {} of {} and bone {} of {}",
                            part.name, weight.vertex, count, weight.bone, file.scene.bones.size()));
    }
    if (!(weight.value >= 0) || !std::isfinite(weight.value)) {
      file.fail(
          fmt::format("vertex {} of mesh '{}' has the weight {} on bone '{}': weights must be "
                      "finite and not negative",
                      weight.vertex, part.name, weight.value, file.scene.bones[weight.bone].name));
    }
  }
}

}  // namespace

void check_part(const MeshFile& file, const MeshPart& part) {
  check_positions(file, part);
  check_triangles(file, part);
  check_uvs(file, part);
  check_colors(file, part);
  check_weights(file, part);
}

}  // namespace hypotrack::internal
