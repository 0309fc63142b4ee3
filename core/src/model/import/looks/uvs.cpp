#include <map>
#include <utility>

#include "model/import/steps.hpp"

namespace hypotrack::internal {

void set_uvs(const std::vector<Eigen::Matrix<float, 2, 3>>& corners, Mesh& mesh) {
  std::map<std::pair<float, float>, int> known;
  std::vector<Eigen::Vector2f> uvs;
  mesh.uv_triangles.resize(3, static_cast<Eigen::Index>(corners.size()));
  for (std::size_t t = 0; t < corners.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2f uv = corners[t].col(k);
      const auto [entry, is_new] =
          known.emplace(std::pair(uv.x(), uv.y()), static_cast<int>(uvs.size()));
      if (is_new) uvs.push_back(uv);
      mesh.uv_triangles(k, static_cast<Eigen::Index>(t)) = entry->second;
    }
  }
  mesh.uv.resize(2, static_cast<Eigen::Index>(uvs.size()));
  for (std::size_t i = 0; i < uvs.size(); ++i) {
    mesh.uv.col(static_cast<Eigen::Index>(i)) = uvs[i];
  }
}

}  // namespace hypotrack::internal
