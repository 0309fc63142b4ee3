#include "cuda/work_of_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hypotrack::cuda {
namespace {

constexpr int kRows = 64;  // that the scene's height is divided into

/// How much of the surface that the first camera may see each row has, in any unit.
std::array<float, kRows> surface_of_rows(const PosedScene& scene) {
  constexpr std::size_t kEnough = 512;  // triangles
  const ScenePlan& plan = scene.plan();
  const float *x = scene.vertices().x(), *y = scene.vertices().y(), *z = scene.vertices().z();
  const Bounds& bounds = scene.bounds()[0];
  const float per_height = kRows / (bounds.y1 - bounds.y0);
  const std::size_t every = std::max<std::size_t>(plan.triangle_count / kEnough, 1);
  std::array<float, kRows> rows{};
  for (const TriangleRange& range : plan.ranges) {
    for (std::size_t t = range.begin; t < range.end; t += every) {
      const std::uint32_t* corners = plan.corners.data() + 4 * t;
      std::array<float, 3> u, v;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t i = corners[k] / kRecord;
        u[k] = x[i] / z[i];
        v[k] = y[i] / z[i];
      }
      const float area = (u[1] - u[0]) * (v[2] - v[0]) - (u[2] - u[0]) * (v[1] - v[0]);
      const float centre = ((v[0] + v[1] + v[2]) / 3 - bounds.y0) * per_height;
      if (!std::isfinite(area + centre)) continue;
      const auto row = static_cast<int>(std::clamp(centre, 0.0f, kRows - 1.0f));
      rows[static_cast<std::size_t>(row)] += std::abs(area);
    }
  }
  return rows;
}

}  // namespace

WorkEnds even_work() {
  WorkEnds ends{};
  for (int k = 0; k <= kMostBands; ++k) ends[k] = static_cast<float>(k) / kMostBands;
  return ends;
}

WorkEnds work_of(const PosedScene& scene) {
  if (!scene.in_front()) return even_work();
  std::array<float, kRows> work = surface_of_rows(scene);
  const float surface = std::accumulate(work.begin(), work.end(), 0.0f);
  if (!(surface > 0)) return even_work();
  for (float& row : work) row += 0.5f * surface / kRows;
  WorkEnds ends{};
  int row = 0;
  float before = 0;  // the rows above
  for (int k = 1; k < kMostBands; ++k) {
    const float wanted = 1.5f * surface * static_cast<float>(k) / kMostBands;
    while (row < kRows - 1 && before + work[row] < wanted) before += work[row++];
    const float within = std::clamp((wanted - before) / work[row], 0.0f, 1.0f);
    ends[k] = (static_cast<float>(row) + within) / kRows;
  }
  ends[kMostBands] = 1;
  return ends;
}

}  // namespace hypotrack::cuda
