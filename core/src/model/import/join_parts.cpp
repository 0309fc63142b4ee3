#include <fmt/format.h>

#include <cstdint>

#include "model/import/srgb.hpp"
#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

using mesh_wire::MeshPart;

constexpr std::size_t kMostVertices = 10'000'000;

Soup empty_soup(const MeshFile& file, std::size_t points, std::size_t triangles, bool has_uvs) {
  constexpr std::uint8_t kWhite = 255;
  Soup soup;
  soup.points.resize(3, static_cast<Eigen::Index>(points));
  soup.triangles.resize(3, static_cast<Eigen::Index>(triangles));
  if (has_uvs) soup.uvs.resize(points, Eigen::Vector2f::Zero());
  soup.parts.reserve(triangles);
  soup.colors.resize(points, {kWhite, kWhite, kWhite});
  if (!file.scene.bones.empty()) soup.influences.resize(points);
  return soup;
}

/// Sets the colours of a part's points: its own, times the factor of its material. Without own ones
/// they stay white. A picture has the factor of its material already.
void join_colors(const MeshFile& file, const MeshPart& part, std::size_t first, Soup& soup) {
  if (part.colors.empty()) return;
  Eigen::Vector3f factor = Eigen::Vector3f::Ones();
  if (part.material < file.scene.materials.size()) {
    const mesh_wire::Material& material = file.scene.materials[part.material];
    if (material.texture.empty()) factor = light_factor(material);
  }
  std::array<std::array<std::uint8_t, 256>, 3> table{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < 256; ++i) {
      const float light = factor[static_cast<Eigen::Index>(c)] * srgb::light_of_bytes()[i];
      table[c][i] = srgb::byte(srgb::encoded(light));
    }
  }
  for (std::size_t i = 0; i < part.positions.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) soup.colors[first + i][c] = table[c][part.colors[i][c]];
}

void join_part(const MeshFile& file, const MeshPart& part, Eigen::Index point,
               Eigen::Index triangle, Soup& soup) {
  const auto first = static_cast<std::size_t>(point);
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    soup.points.col(point + static_cast<Eigen::Index>(i)) =
        static_cast<float>(file.options.scale) *
        Eigen::Map<const Eigen::Vector3f>(part.positions[i].data());
    if (!soup.uvs.empty() && !part.uvs.empty()) {
      soup.uvs[first + i] = Eigen::Map<const Eigen::Vector2f>(part.uvs[i].data());
    }
  }
  join_colors(file, part, first, soup);
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
  bool has_uvs = false;
  for (const MeshPart& part : file.scene.meshes) {
    check_part(file, part);
    points += part.positions.size();
    triangles += part.triangles.size();
    has_uvs = has_uvs || !part.uvs.empty();
  }
  if (triangles == 0) file.fail("the mesh has no faces");
  if (points > kMostVertices || triangles > kMostVertices) {
    file.fail(
        fmt::format("the mesh has {} vertices and {} triangles: decimate it", points, triangles));
  }
  Soup soup = empty_soup(file, points, triangles, has_uvs);
  Eigen::Index point = 0;
  Eigen::Index triangle = 0;
  for (const MeshPart& part : file.scene.meshes) {
    join_part(file, part, point, triangle, soup);
    point += static_cast<Eigen::Index>(part.positions.size());
    triangle += static_cast<Eigen::Index>(part.triangles.size());
  }
  return soup;
}

}  // namespace hypotrack::internal
