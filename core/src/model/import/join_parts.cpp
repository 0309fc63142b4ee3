#include <fmt/format.h>

#include "model/import/steps.hpp"

namespace hypotrack {
namespace {

using mesh_wire::MeshPart;

constexpr std::size_t kMostVertices = 10'000'000;

Soup empty_soup(const MeshFile& file, std::size_t points, std::size_t triangles, bool has_uvs) {
  Soup soup;
  soup.points.resize(3, static_cast<Eigen::Index>(points));
  soup.triangles.resize(3, static_cast<Eigen::Index>(triangles));
  if (has_uvs) soup.uvs.resize(points);
  if (!file.scene.bones.empty()) soup.influences.resize(points);
  return soup;
}

void join_part(const MeshFile& file, const MeshPart& part, bool has_uvs, Eigen::Index point,
               Eigen::Index triangle, Soup& soup) {
  const auto first = static_cast<std::size_t>(point);
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    soup.points.col(point + static_cast<Eigen::Index>(i)) =
        static_cast<float>(file.options.scale) *
        Eigen::Map<const Eigen::Vector3f>(part.positions[i].data());
    if (has_uvs && !part.uvs.empty()) {
      soup.uvs[first + i] = Eigen::Map<const Eigen::Vector2f>(part.uvs[i].data());
    }
  }
  for (const auto& corners : part.triangles) {
    for (int k = 0; k < 3; ++k) {
      soup.triangles(k, triangle) =
          static_cast<int>(point) + static_cast<int>(corners[static_cast<std::size_t>(k)]);
    }
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
  bool has_uvs = true;
  for (const MeshPart& part : file.scene.meshes) {
    check_part(file, part);
    points += part.positions.size();
    triangles += part.triangles.size();
    has_uvs = has_uvs && (!part.uvs.empty() || part.triangles.empty());
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
    join_part(file, part, has_uvs, point, triangle, soup);
    point += static_cast<Eigen::Index>(part.positions.size());
    triangle += static_cast<Eigen::Index>(part.triangles.size());
  }
  return soup;
}

}  // namespace hypotrack
