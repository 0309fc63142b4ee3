#include "shape/coverage.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::internal {

std::int64_t covered_pixels(const DepthTile& tile) {
  std::int64_t count = 0;
  for (int y = tile.y0; y < tile.y1; ++y) {
    const float* row = tile.inverse_depth + static_cast<std::ptrdiff_t>(y) * tile.stride;
    count += std::count_if(row + tile.x0, row + tile.x1, [](float w) { return w > 0; });
  }
  return count;
}

void Coverage::do_prepare(const Observation& observation) {
  const TileCamera& camera = observation.views.front().camera;
  count_ = std::int64_t{camera.width} * camera.height;
}

double Coverage::do_cost(const RenderedHypothesis& hypothesis) const {
  return penalty_ * static_cast<double>(covered_pixels(hypothesis.views.front()));
}

void Coverage::do_write_residuals(const RenderedHypothesis& hypothesis,
                                  std::span<float> residuals) const {
  std::fill(residuals.begin(), residuals.end(), 0.0f);
  const auto value = static_cast<float>(std::sqrt(penalty_));
  const DepthTile& tile = hypothesis.views.front();
  for (int y = tile.y0; y < tile.y1; ++y) {
    const float* row = tile.inverse_depth + static_cast<std::ptrdiff_t>(y) * tile.stride;
    float* out = residuals.data() + static_cast<std::ptrdiff_t>(y) * tile.width;
    for (int x = tile.x0; x < tile.x1; ++x)
      if (row[x] > 0) out[x] = value;
  }
}

}  // namespace hypotrack::internal
