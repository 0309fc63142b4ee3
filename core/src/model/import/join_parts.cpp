#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <optional>

#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

using mesh_wire::MeshPart;

constexpr std::size_t kMostVertices = 10'000'000;

/// What the parts with triangles have: all of them, unless said.
struct Features {
  bool uvs = true, colors = true;
  bool some_uvs = false;  // a part has texture coordinates
};

/// Returns true if parts differ in the colours of their materials, and none has a texture.
bool has_colored_parts(const MeshFile& file) {
  std::optional<Eigen::Vector3f> first;
  bool differ = false;
  for (const MeshPart& part : file.scene.meshes) {
    if (part.triangles.empty()) continue;
    const Eigen::Vector3f color = material_color(file, part);
    if (!color.allFinite() || !file.scene.materials[part.material].texture.empty()) return false;
    if (!first) first = color;
    differ |= color != *first;
  }
  return differ;
}

Soup empty_soup(const MeshFile& file, std::size_t points, std::size_t triangles,
                const Features& has) {
  Soup soup;
  soup.points.resize(3, static_cast<Eigen::Index>(points));
  soup.triangles.resize(3, static_cast<Eigen::Index>(triangles));
  if (has.some_uvs) soup.uvs.resize(points, Eigen::Vector2f::Zero());
  soup.has_all_uvs = has.uvs;
  soup.parts.reserve(triangles);
  if (has.colors || has_colored_parts(file)) soup.colors.resize(points);
  if (!file.scene.bones.empty()) soup.influences.resize(points);
  return soup;
}

/// Returns the factor on the colours of a part's vertices: in glTF the colour of its material.
Eigen::Vector3f color_factor(const MeshFile& file, const MeshPart& part) {
  const bool gltf = file.path.extension().string().size() > 2 &&
                    std::tolower(file.path.extension().string()[1]) == 'g';
  if (!gltf) return Eigen::Vector3f::Ones();
  const Eigen::Vector3f color = material_color(file, part);
  return color.allFinite() ? color : Eigen::Vector3f::Ones();
}

/// Sets the colours of a part's points: their own, or that of the part's material.
void join_colors(const MeshFile& file, const MeshPart& part, std::size_t first, bool own,
                 Soup& soup) {
  if (soup.colors.empty()) return;
  const Eigen::Vector3f factor = own ? color_factor(file, part) : material_color(file, part);
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int color = own ? part.colors[i][c] : 255;
      soup.colors[first + i][c] = static_cast<std::uint8_t>(
          std::lround(factor[static_cast<Eigen::Index>(c)] * static_cast<float>(color)));
    }
  }
}

void join_part(const MeshFile& file, const MeshPart& part, Eigen::Index point,
               Eigen::Index triangle, const Features& has, Soup& soup) {
  const auto first = static_cast<std::size_t>(point);
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    soup.points.col(point + static_cast<Eigen::Index>(i)) =
        static_cast<float>(file.options.scale) *
        Eigen::Map<const Eigen::Vector3f>(part.positions[i].data());
    if (!soup.uvs.empty() && !part.uvs.empty()) {
      soup.uvs[first + i] = Eigen::Map<const Eigen::Vector2f>(part.uvs[i].data());
    }
  }
  if (!part.triangles.empty()) join_colors(file, part, first, has.colors, soup);
  for (const auto& corners : part.triangles) {
    for (int k = 0; k < 3; ++k) {
      soup.triangles(k, triangle) =
          static_cast<int>(point) + static_cast<int>(corners[static_cast<std::size_t>(k)]);
    }
    soup.parts.push_back(static_cast<std::size_t>(&part - file.scene.meshes.data()));
    ++triangle;
  }
  if (file.scene.bones.empty()) return;
  for (const mesh_wire::Weight& weight : part.weights) {
    soup.influences[first + weight.vertex].push_back({static_cast<int>(weight.bone), weight.value});
  }
  check_weight_sums(file, part, soup, first);
}

}  // namespace

Soup join_parts(const MeshFile& file) {
  std::size_t points = 0;
  std::size_t triangles = 0;
  Features has;
  for (const MeshPart& part : file.scene.meshes) {
    check_part(file, part);
    points += part.positions.size();
    triangles += part.triangles.size();
    if (part.triangles.empty()) continue;
    has.uvs = has.uvs && !part.uvs.empty();
    has.some_uvs = has.some_uvs || !part.uvs.empty();
    has.colors = has.colors && !part.colors.empty();
  }
  if (triangles == 0) file.fail("the mesh has no faces");
  if (points > kMostVertices || triangles > kMostVertices) {
    file.fail(
        fmt::format("the mesh has {} vertices and {} triangles: decimate it", points, triangles));
  }
  Soup soup = empty_soup(file, points, triangles, has);
  Eigen::Index point = 0;
  Eigen::Index triangle = 0;
  for (const MeshPart& part : file.scene.meshes) {
    join_part(file, part, point, triangle, has, soup);
    point += static_cast<Eigen::Index>(part.positions.size());
    triangle += static_cast<Eigen::Index>(part.triangles.size());
  }
  return soup;
}

}  // namespace hypotrack::internal
