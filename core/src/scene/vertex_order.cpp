#include <algorithm>
#include <array>
#include <numeric>

#include "scene/mesh_topology.hpp"

namespace hypotrack::internal {
namespace {

// Returns the bones of a vertex, in rising order.
std::array<int, 4> holding_bones(const Mesh& mesh, int vertex) {
  std::array<int, 4> bones{-1, -1, -1, -1};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    if (mesh.bone_weights(row, vertex) > 0) bones[k] = mesh.bone_indices(row, vertex);
  }
  std::sort(bones.begin(), bones.end());
  return bones;
}

}  // namespace

std::vector<int> order_by_bones(const Mesh& mesh) {
  std::vector<int> order(static_cast<std::size_t>(mesh.vertices.cols()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return holding_bones(mesh, a) < holding_bones(mesh, b); });
  return order;
}

}  // namespace hypotrack::internal
