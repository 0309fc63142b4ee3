#include <cmath>
#include <map>
#include <utility>

#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

using Corners = Eigen::Matrix<float, 2, 3>;

}  // namespace

Corners corners_in_image(const Soup& soup, int triangle) {
  Corners corners = Corners::Zero();
  if (soup.uvs.empty()) return corners;
  for (int k = 0; k < 3; ++k) {
    corners.col(k) = soup.uvs[static_cast<std::size_t>(soup.triangles(k, triangle))];
  }
  const Eigen::Vector2f low = corners.rowwise().minCoeff();
  const Eigen::Vector2f high = corners.rowwise().maxCoeff();
  for (int axis = 0; axis < 2; ++axis) {
    if (low[axis] < -1e-4f || high[axis] > 1 + 1e-4f) {
      corners.row(axis).array() -= std::floor(low[axis]);
    }
  }
  return corners.cwiseMax(0.0f).cwiseMin(1.0f);
}

void fill_uvs(const Soup& soup, const std::vector<int>& kept, Mesh& mesh) {
  std::map<std::pair<float, float>, int> known;
  std::vector<Eigen::Vector2f> uvs;
  mesh.uv_triangles.resize(3, mesh.triangles.cols());
  for (std::size_t t = 0; t < kept.size(); ++t) {
    const Corners corners = corners_in_image(soup, kept[t]);
    for (int k = 0; k < 3; ++k) {
      const auto [entry, is_new] =
          known.emplace(std::pair(corners(0, k), corners(1, k)), static_cast<int>(uvs.size()));
      if (is_new) uvs.push_back(corners.col(k));
      mesh.uv_triangles(k, static_cast<Eigen::Index>(t)) = entry->second;
    }
  }
  mesh.uv.resize(2, static_cast<Eigen::Index>(uvs.size()));
  for (std::size_t i = 0; i < uvs.size(); ++i) {
    mesh.uv.col(static_cast<Eigen::Index>(i)) = uvs[i];
  }
}

}  // namespace hypotrack::internal
