#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

/// Returns which points are corners of triangles. The weights of others are unchecked.
std::vector<bool> used_points(const Soup& soup) {
  std::vector<bool> used(static_cast<std::size_t>(soup.points.cols()));
  for (const int corner : soup.triangles.reshaped()) used[static_cast<std::size_t>(corner)] = true;
  return used;
}

}  // namespace

void fill_weights(const Soup& soup, const Welded& welded, Mesh& mesh) {
  const Eigen::Index count = mesh.vertices.cols();
  if (soup.influences.empty()) {
    mesh.bone_indices.resize(4, 0);
    mesh.bone_weights.resize(4, 0);
    return;
  }
  std::vector<std::vector<BoneWeight>> merged(static_cast<std::size_t>(count));
  const std::vector<bool> used = used_points(soup);
  for (std::size_t i = 0; i < welded.same.size(); ++i) {
    if (!used[i]) continue;
    const int vertex = welded.vertex[static_cast<std::size_t>(welded.same[i])];
    if (vertex < 0) continue;
    auto& all = merged[static_cast<std::size_t>(vertex)];
    all.insert(all.end(), soup.influences[i].begin(), soup.influences[i].end());
  }
  mesh.bone_indices.setZero(4, count);
  mesh.bone_weights.setZero(4, count);
  for (Eigen::Index v = 0; v < count; ++v) {
    const auto strongest = strongest_influences(merged[static_cast<std::size_t>(v)]);
    for (std::size_t k = 0; k < strongest.size(); ++k) {
      mesh.bone_indices(static_cast<Eigen::Index>(k), v) = strongest[k].bone;
      mesh.bone_weights(static_cast<Eigen::Index>(k), v) = strongest[k].weight;
    }
  }
}

}  // namespace hypotrack::internal
