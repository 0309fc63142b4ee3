#include "track/smooth/tile_highlights.hpp"

#include "tile/resample.hpp"
#include "track/color/color_fit.hpp"
#include "track/color/color_samples.hpp"

namespace hypotrack::internal {

void TileHighlights::learn(const std::vector<FrameTiles>& tiles,
                           const std::vector<TimedState>& states) {
  for (Highlights& view : views_) view.forget();
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (!tiles[i] || tiles[i]->views.size() < 2) continue;
    views_.resize(tiles[i]->views.size() - 1, Highlights(1));
    sampler_.draw(*tiles[i], states[i].state);
    for (std::size_t k = 0; k < views_.size(); ++k) {
      const ColorSamples samples = sampler_.take(*tiles[i], k + 1, true);
      if (samples.size() == 0) continue;
      views_[k].learn(samples.normals, gray_difference(samples, {}), sampler_.directions(k + 1));
    }
  }
}

Observation TileHighlights::off(const Observation& tiles, const Eigen::VectorXd& state) {
  Observation out = tiles;
  if (views_.empty()) return out;
  sampler_.draw(tiles, state);
  for (std::size_t k = 0; k < views_.size(); ++k) {
    TileView& view = out.views[k + 1];
    if (view.color.empty()) continue;
    const ColorSampler::NormalGrid grid = sampler_.normals(k + 1);
    const Eigen::VectorXf missing = views_[k].expected(grid.normals, sampler_.directions(k + 1));
    view.color = brightened(view.color, extrapolate(grid.inside, missing, view.color.size()));
  }
  return out;
}

}  // namespace hypotrack::internal
