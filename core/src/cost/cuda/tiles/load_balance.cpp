#include "cost/cuda/tiles/load_balance.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::cuda::internal {
namespace {

constexpr int kRows = 64;  // number of parts of the scene's height

/// Fixed cost of a triangle, in pixels (measured on an H200).
constexpr float kPerTriangle = 1.5f;
/// Fixed cost of a row, as a share of the average row's surface pixels.
constexpr float kPerRow = 0.5f;

/// Work of the surface that the first camera may see, per row and in total.
struct Work {
  std::array<float, kRows> rows{};
  float pixels = 0, all = 0;
};

Work work_of_surface(const PosedScene& scene, const TileCamera& tile) {
  constexpr std::size_t kEnough = 512;  // triangles to sample
  const ScenePlan& plan = scene.plan();
  const float *x = scene.vertices().x(), *y = scene.vertices().y(), *z = scene.vertices().z();
  const Bounds& bounds = scene.bounds()[0];
  const float per_height = kRows / (bounds.y1 - bounds.y0);
  const auto pixels_per_area = static_cast<float>(0.5 * tile.fx * tile.fy);
  const std::size_t every = std::max<std::size_t>(plan.triangle_count / kEnough, 1);
  Work work;
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
      const float pixels = std::abs(area) * pixels_per_area;
      const auto row = static_cast<int>(std::clamp(centre, 0.0f, kRows - 1.0f));
      work.rows[static_cast<std::size_t>(row)] += pixels + kPerTriangle;
      work.pixels += pixels;
      work.all += pixels + kPerTriangle;
    }
  }
  return work;
}

}  // namespace

BandEnds even_bands() {
  BandEnds ends{};
  for (int k = 0; k <= kMostBands; ++k) ends[k] = static_cast<float>(k) / kMostBands;
  return ends;
}

BandEnds bands_of_equal_work(const PosedScene& scene, const TileCamera& tile) {
  if (!scene.in_front()) return even_bands();
  Work work = work_of_surface(scene, tile);
  if (!(work.pixels > 0)) return even_bands();
  for (float& row : work.rows) row += kPerRow * work.pixels / kRows;
  work.all += kPerRow * work.pixels;
  BandEnds ends{};
  int row = 0;
  float before = 0;  // work of the rows above
  for (int k = 1; k < kMostBands; ++k) {
    const float wanted = work.all * static_cast<float>(k) / kMostBands;
    while (row < kRows - 1 && before + work.rows[row] < wanted) before += work.rows[row++];
    const float within = std::clamp((wanted - before) / work.rows[row], 0.0f, 1.0f);
    ends[k] = (static_cast<float>(row) + within) / kRows;
  }
  ends[kMostBands] = 1;
  return ends;
}

}  // namespace hypotrack::cuda::internal
